//! The mannequin: everything the other parts need of a body.

use crate::attach::posed;
use crate::bones;
use crate::landmarks::Landmarks;
use crate::marks::Marks;
use crate::request::Request;
use crate::rings;
use crate::solve::Grown;
use crate::template::Template;
use crate::warp::{Follow, Warp};
use crate::{AttachedPrimitive, BodyError, Field, Figure, Part, Pose, Primitive, Skeleton};
use nalgebra::Rotation3;
use toile_geometry::{ClosestPoint, SurfaceTree, TriangleMesh, Vec3};
use toile_measure::Measurements;

/// A body of given measurements: skeleton, ellipsoid primitives and skin. Facing +Z, standing on
/// y = 0, arms straight and held off at the angle asked for, legs apart.
pub struct Mannequin {
    pub(crate) figure: Figure,
    pub(crate) measurements: Measurements,
    pub(crate) request: Request,
    pub(crate) template_primitives: Vec<Primitive>,
    pub(crate) skin: SurfaceTree,
    pub(crate) parts: Vec<Part>,
    pub(crate) skeleton: Skeleton,
    pub(crate) primitives: Vec<AttachedPrimitive>,
    pub(crate) field: Field,
    pub(crate) landmarks: Landmarks,
}

/// Girths a body must have as asked.
const GIRTHS: [&str; 5] = ["bust", "underbust", "waist", "hips", "leg_circ"];
/// Largest difference of a girth from what was asked [m]: more would change the size worn.
const LARGEST_GAP: f64 = 5e-3;

impl Mannequin {
    /// Makes the body of a figure with the given measurements.
    ///
    /// # Errors
    /// A measurement that is missing, that no adult has, or that contradicts another.
    pub fn new(measurements: &Measurements, figure: Figure) -> Result<Self, BodyError> {
        Self::from_template(measurements, figure, Template::of(figure))
    }

    pub(crate) fn from_template(
        measurements: &Measurements,
        figure: Figure,
        template: Template,
    ) -> Result<Self, BodyError> {
        let request = Request::read(measurements)?;
        let skin = rings::cast(&template, &Field::new(&template.primitives))?;
        let marks = Marks::of(&template, &skin)?;
        let grown = Grown {
            template: &template,
            skin: &skin,
            marks,
            request,
        };
        let (shape, mesh) = grown.solve()?;
        let warp = Warp::new(&template, shape);
        let skeleton = bones::skeleton(&template, &warp);
        let primitives: Vec<AttachedPrimitive> = template
            .primitives
            .iter()
            .map(|primitive| {
                let joint = bones::joint_of(&template, primitive);
                AttachedPrimitive::new(joint, &carried(primitive, &warp), &skeleton)
            })
            .collect();
        let landmarks = Landmarks::find(&grown, &warp, &mesh);
        let body = Self {
            figure,
            measurements: measurements.clone(),
            request,
            field: Field::new(&posed(&primitives, &skeleton, &Pose::rest())),
            skeleton,
            primitives,
            skin: SurfaceTree::new(mesh),
            parts: skin.parts,
            landmarks,
            template_primitives: template.primitives,
        };
        body.refuse_unmet()?;
        Ok(body)
    }

    /// Refuses a body whose girths are not those asked for: far from any real table the sections
    /// influence each other so much that no warp meets them all.
    fn refuse_unmet(&self) -> Result<(), BodyError> {
        for gap in self.measure() {
            if GIRTHS.contains(&gap.name) && gap.gap().abs() >= LARGEST_GAP {
                let (name, asked, got) = (gap.name, gap.asked, gap.got);
                return Err(BodyError::Unmet { name, asked, got });
            }
        }
        Ok(())
    }

    /// The figure it was grown from.
    pub fn figure(&self) -> Figure {
        self.figure
    }

    /// The measurements asked for.
    pub fn measurements(&self) -> &Measurements {
        &self.measurements
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
    /// coarse description of the body, carried from the template's by the map of the skin,
    /// linearised at their centres.
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

/// A primitive carried by the derivative J of the map at its centre: the ellipsoid with the matrix
/// `J R S`, whose singular vectors and values are the new axes.
fn carried(primitive: &Primitive, warp: &Warp) -> Primitive {
    if primitive.is_right() {
        return carried(&primitive.mirrored(), warp).mirrored();
    }
    let follow = match primitive.part {
        Part::LeftArm | Part::RightArm => Follow { arm: 1.0, leg: 0.0 },
        Part::LeftLeg | Part::RightLeg => Follow { arm: 0.0, leg: 1.0 },
        Part::Trunk | Part::Head => Follow::default(),
    };
    let centre = Vec3::from(primitive.centre);
    let old = *primitive.rotation().matrix();
    let scaled = old * nalgebra::Matrix3::from_diagonal(&Vec3::from(primitive.radii));
    let svd = (warp.derivative(centre, follow) * scaled).svd(true, false);
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
