//! The mannequin: everything the other parts need of a body.

use crate::attach::posed;
use crate::bones;
use crate::field::VISIBLE_RATIO;
use crate::landmarks::Landmarks;
use crate::levels::Levels;
use crate::marks::Marks;
use crate::refit::refitted;
use crate::request::Request;
use crate::rings::{self, TemplateSkin};
use crate::skinning::Skinning;
use crate::solve::{Grown, Solved};
use crate::template::Template;
use crate::warp::{Follow, Warp};
use crate::{AttachedPrimitive, BodyError, Field, Figure, Part, Pose, Primitive, Skeleton};
use nalgebra::Rotation3;
use std::sync::OnceLock;
use toile_geometry::{ClosestPoint, SurfaceTree, TriangleMesh, Vec3};
use toile_measure::Measurements;

/// A body of given measurements: skeleton, ellipsoid primitives and skin. Facing +Z, standing on
/// y = 0, arms straight and held off at the angle asked for, legs apart.
pub struct Mannequin {
    pub(crate) figure: Figure,
    pub(crate) measurements: Measurements,
    pub(crate) request: Request,
    pub(crate) template_primitives: Vec<Primitive>,
    pub(crate) marks: Marks,
    pub(crate) levels: Levels,
    pub(crate) warp: Warp,
    pub(crate) crotch: Vec<u32>,
    pub(crate) armpit: u32,
    pub(crate) skinning: Skinning,
    pub(crate) skin: SurfaceTree,
    pub(crate) parts: Vec<Part>,
    pub(crate) skeleton: Skeleton,
    pub(crate) primitives: Vec<AttachedPrimitive>,
    pub(crate) field: Field,
    pub(crate) landmarks: Landmarks,
}

/// A template's skin and marks.
type Cast = (TemplateSkin, Marks);

/// The skins of the figures' own templates, cast when first needed.
static CAST: [OnceLock<Result<Cast, BodyError>>; 3] =
    [OnceLock::new(), OnceLock::new(), OnceLock::new()];

fn cast(template: &Template) -> Result<Cast, BodyError> {
    let skin = rings::cast(template, &Field::new(&template.primitives))?;
    let marks = Marks::of(template, &skin)?;
    Ok((skin, marks))
}

impl Mannequin {
    /// Makes the body of a figure with the given measurements: any of the catalogue. What is
    /// missing is predicted from them; what contradicts itself is met in the sense of least
    /// squares and named by [`Mannequin::conflicts`].
    ///
    /// # Errors
    /// A measurement that no body has, or lengths that leave no room for a landmark.
    pub fn new(measurements: &Measurements, figure: Figure) -> Result<Self, BodyError> {
        let template = Template::of(figure);
        let cast = CAST[figure as usize].get_or_init(|| cast(&template));
        let (skin, marks) = cast.as_ref().map_err(Clone::clone)?;
        Self::grown(measurements, figure, (&template, skin, *marks))
    }

    pub(crate) fn from_template(
        measurements: &Measurements,
        figure: Figure,
        template: Template,
    ) -> Result<Self, BodyError> {
        let (skin, marks) = cast(&template)?;
        Self::grown(measurements, figure, (&template, &skin, marks))
    }

    fn grown(
        measurements: &Measurements,
        figure: Figure,
        (template, skin, marks): (&Template, &TemplateSkin, Marks),
    ) -> Result<Self, BodyError> {
        let grown = Grown {
            template,
            skin,
            marks,
            request: Request::read(measurements, figure)?,
        };
        let Solved {
            shape,
            levels,
            mesh,
        } = grown.solve()?;
        let warp = Warp::new(template, &marks, shape);
        let skeleton = bones::skeleton(template, &warp);
        let left: Vec<Primitive> = template
            .primitives
            .iter()
            .filter(|primitive| !primitive.is_right())
            .map(|primitive| {
                let mut body = carried(primitive, &warp);
                if primitive.is_central() {
                    body.centre[0] = 0.0;
                    body.rotation[1] = 0.0;
                    body.rotation[2] = 0.0;
                }
                body
            })
            .collect();
        let primitives: Vec<AttachedPrimitive> = refitted(left, &mesh, &skin.parts)
            .iter()
            .zip(&template.primitives)
            .map(|(primitive, of_template)| {
                let joint = bones::joint_of(template, of_template);
                AttachedPrimitive::new(joint, primitive, &skeleton)
            })
            .collect();
        let landmarks = Landmarks::find(&grown, (&levels, &warp), &mesh);
        let mut body = Self {
            figure,
            measurements: measurements.clone(),
            field: Field::new(&posed(&primitives, &skeleton, &Pose::rest())),
            skeleton,
            primitives,
            skin: SurfaceTree::new(mesh),
            parts: skin.parts.clone(),
            landmarks,
            template_primitives: template.primitives.clone(),
            crotch: grown.crotch_vertices(),
            armpit: skin.armpit,
            request: grown.request,
            marks,
            levels,
            warp,
            skinning: Skinning::default(),
        };
        body.skinning = Skinning::new(&body, &skin.arm, &skin.leg);
        Ok(body)
    }

    /// The figure it was grown from.
    pub fn figure(&self) -> Figure {
        self.figure
    }

    /// The measurements asked for.
    pub fn measurements(&self) -> &Measurements {
        &self.measurements
    }

    /// The measurements asked for with predictions of the rest, each marked.
    pub fn completed(&self) -> &Measurements {
        &self.request.table
    }

    /// The skin: closed, outward, the same triangles for every set of measurements of a figure.
    pub fn skin(&self) -> &TriangleMesh {
        self.skin.mesh()
    }

    /// The skin with its box tree.
    pub fn skin_tree(&self) -> &SurfaceTree {
        &self.skin
    }

    /// The part each triangle of the skin belongs to.
    pub fn part_of_triangle(&self) -> &[Part] {
        &self.parts
    }

    /// The joints, where they are at rest.
    pub fn skeleton(&self) -> &Skeleton {
        &self.skeleton
    }

    /// The ellipsoid primitives of the body, each in the frame of the joint it is fixed to: a
    /// coarse description of the body, carried from the template's by the map of the skin and
    /// scaled to lie on it.
    pub fn primitives(&self) -> &[AttachedPrimitive] {
        &self.primitives
    }

    /// The primitives in the body's frame, at rest, in the order of [`Mannequin::primitives`].
    pub fn ellipsoids(&self) -> Vec<Primitive> {
        self.posed_ellipsoids(&Pose::rest())
    }

    /// The primitives in the body's frame, in a pose: each goes rigidly with its joint.
    pub fn posed_ellipsoids(&self, pose: &Pose) -> Vec<Primitive> {
        posed(&self.primitives, &self.skeleton, pose)
    }

    /// The implicit surface of the primitives at rest.
    pub fn field(&self) -> &Field {
        &self.field
    }

    /// Named points of the body.
    pub fn landmarks(&self) -> &Landmarks {
        &self.landmarks
    }

    /// Whether a point lies inside the skin. Exact.
    pub fn contains(&self, point: Vec3) -> bool {
        self.skin.contains(point)
    }

    /// The closest point of the skin. Exact up to rounding; nothing for a point that is not
    /// finite.
    pub fn closest_point(&self, point: Vec3) -> Option<ClosestPoint> {
        self.skin.closest_point(point, f64::INFINITY)
    }
}

/// A primitive carried by the map: the ellipsoid through what becomes of its visible axes, whose
/// singular vectors and values are the new ones.
fn carried(primitive: &Primitive, warp: &Warp) -> Primitive {
    let follow = match primitive.part {
        Part::LeftArm | Part::RightArm => Follow { arm: 1.0, leg: 0.0 },
        Part::LeftLeg | Part::RightLeg => Follow { arm: 0.0, leg: 1.0 },
        Part::Trunk | Part::Head => Follow::default(),
    };
    let centre = Vec3::from(primitive.centre);
    let old = *primitive.rotation().matrix();
    let scaled = old * nalgebra::Matrix3::from_diagonal(&Vec3::from(primitive.radii));
    // Taken over the visible axes: the map differs across them.
    let axes = warp.carried_axes(centre, scaled * VISIBLE_RATIO, follow) / VISIBLE_RATIO;
    let svd = axes.svd(true, false);
    let (Some(vectors), values) = (svd.u, svd.singular_values) else {
        return *primitive;
    };
    // Each new axis takes the place of the old one it is nearest to.
    let mut order = [
        [0, 1, 2],
        [0, 2, 1],
        [1, 0, 2],
        [1, 2, 0],
        [2, 0, 1],
        [2, 1, 0],
    ];
    let fit = |o: &[usize; 3]| -> f64 {
        (0..3)
            .map(|k| vectors.column(o[k]).dot(&old.column(k)).abs())
            .sum()
    };
    order.sort_by(|a, b| fit(b).total_cmp(&fit(a)));
    let order = order[0];
    let mut axes = nalgebra::Matrix3::zeros();
    for (k, &from) in order.iter().enumerate() {
        let column = vectors.column(from);
        let sign = if column.dot(&old.column(k)) < 0.0 {
            -1.0
        } else {
            1.0
        };
        axes.set_column(k, &(column * sign));
    }
    if axes.determinant() < 0.0 {
        let third = -axes.column(2);
        axes.set_column(2, &third);
    }
    Primitive {
        part: primitive.part,
        centre: warp.apply(centre, follow).into(),
        radii: order.map(|k| values[k]),
        rotation: Rotation3::from_matrix_unchecked(axes).scaled_axis().into(),
    }
}
