//! The mannequin: everything the other parts need of a body.
//!
//! # Decided with
//! - [`crate::request`], [`crate::conflict::conflicts`], [`crate::solve`]: measurements asked for: ranges,
//!   contradictions; the size solved;
//! - [`crate::measured`], [`crate::tape`]: each measurement taken from the skin;
//! - [`crate::template`], [`crate::field::Field`]: template figures; the surface of their primitives;
//! - [`crate::skeleton::Pose`], [`crate::skinning`], [`crate::posed_skin`]: poses and the skin in them;
//! - [`crate::gait`], [`crate::clip::Clip`], [`crate::player::Player`]: clips and what plays them;
//! - [`crate::edits::PrimitiveEdit`], [`crate::rigging::Rigging`], [`crate::proportions::ProportionBox`],
//!   [`crate::scaling::Scaling`]: changes beside measurements: primitives, proportions, ratios;
//! - [`crate::describe::Description`], [`crate::attach`]: a body saved and made again; primitives at their
//!   joints;
//! - [`crate::fit`], [`crate::scan::Scan`]: fitted to a foreign mesh; a mesh measured.
//!
//! Chosen by crate `session` (`mannequin_source.rs`, `bodies.rs`). A garment worn when the body changes: crate
//! `session` (`garment_edit.rs`, `derived.rs`), hung anew by the window (`app/background_work.rs`, `follow`).

use crate::attach::posed;
use crate::bones;
use crate::definitions::NECK_TILT;
use crate::dress_form::DressForm;
use crate::field::VISIBLE_RATIO;
use crate::hang::hang;
use crate::landmarks::Landmarks;
use crate::levels::{self, Level, Levels, SkinOffsets};
use crate::refit::refitted;
use crate::request::Request;
use crate::rings::{self, TemplateSkin};
use crate::sides::sources;
use crate::skinning::Skinning;
use crate::solve::Solved;
use crate::solve_input::SolveInput;
use crate::template::Template;
use crate::template_marks::TemplateMarks;
use crate::warp::{Follow, Warp};
use crate::{AttachedPrimitive, BodyError, Field, Figure, Joint, Part, Pose, Primitive, Skeleton};
use nalgebra::Rotation3;
use std::sync::{Arc, OnceLock};
use toile_geometry::{ClosestPoint, SurfaceTree, TriangleMesh, Vec3};
use toile_measure::{Measurements, Origin};

/// A body of given measurements: skeleton, ellipsoid primitives and skin. Facing +Z, standing on
/// y = 0, arms straight and held off at the angle asked for, legs apart.
pub struct Mannequin {
    pub(crate) figure: Figure,
    pub(crate) measurements: Measurements,
    pub(crate) request: Request,
    pub(crate) template_body: Arc<TemplateBody>,
    pub(crate) levels: Levels,
    pub(crate) warp: Warp,
    /// Vertices of the median plane, of which the lowest is the crotch.
    pub(crate) crotch: Vec<u32>,
    pub(crate) skeleton: Skeleton,
    pub(crate) landmarks: Landmarks,
    /// Skin of the whole body, with head, arms and legs, also for a dress form: the tape measures this skin.
    pub(crate) whole: TriangleMesh,
    /// The dress form cut from the whole body, if the figure is a dress form.
    form: Option<DressForm>,
    // The following fields are computed from the others when first used.
    tree: OnceLock<SurfaceTree>,
    skinning: OnceLock<Skinning>,
    primitives: OnceLock<Vec<AttachedPrimitive>>,
    field: OnceLock<Field>,
}

/// A template with its skin and marks.
pub(crate) struct TemplateBody {
    pub(crate) template: Template,
    pub(crate) skin: TemplateSkin,
    pub(crate) marks: TemplateMarks,
}

impl TemplateBody {
    fn of(mut template: Template) -> Result<Arc<Self>, BodyError> {
        let skin = match template.armpit {
            Some(_) => rings::cast_framed(&mut template)?,
            None => rings::cast(&template, &Field::new(&template.primitives))?,
        };
        let marks = TemplateMarks::of(&template, &skin)?;
        Ok(Arc::new(Self {
            template,
            skin,
            marks,
        }))
    }
}

/// Templates of woman, man and mean, cast when first used.
static TEMPLATE_BODIES: [OnceLock<Result<Arc<TemplateBody>, BodyError>>; 3] =
    [const { OnceLock::new() }; 3];

/// The skin of a figure's own primitives, before any measurement is applied, cast on each call (m).
///
/// # Errors
/// [`BodyError::Open`] for a part whose primitives do not enclose its axis.
pub fn template_skin(figure: Figure) -> Result<TriangleMesh, BodyError> {
    let template = Template::of(figure);
    let skin = rings::cast(&template, &Field::new(&template.primitives))?;
    Ok(skin.mesh)
}

impl Mannequin {
    /// Makes the body of a figure with the given measurements, which may be any of the catalogue. Missing
    /// ones are predicted from them; contradictory ones are met in the sense of least squares and named by
    /// [`Mannequin::conflicts`].
    ///
    /// # Errors
    /// [`BodyError`] for a measurement that no body has, or lengths that leave no room for a landmark.
    pub fn new(measurements: &Measurements, figure: Figure) -> Result<Self, BodyError> {
        let place = match figure {
            Figure::Woman | Figure::DressForm => 0,
            Figure::Man => 1,
            // Children share the template of the mean.
            _ => 2,
        };
        let template_body =
            TEMPLATE_BODIES[place].get_or_init(|| TemplateBody::of(Template::of(figure)));
        Self::grown(measurements, figure, template_body.clone()?)
    }

    pub(crate) fn from_template(
        measurements: &Measurements,
        figure: Figure,
        template: Template,
    ) -> Result<Self, BodyError> {
        Self::grown(measurements, figure, TemplateBody::of(template)?)
    }

    /// The body of a framed template without changes: no measurement is solved for.
    pub(crate) fn still(
        measurements: &Measurements,
        figure: Figure,
        template: Template,
    ) -> Result<Self, BodyError> {
        let template_body = TemplateBody::of(template)?;
        // Missing measurements are predicted from the frame.
        let mut known = measurements.clone();
        let template = &template_body.template;
        for (name, value) in [
            ("height", Some(template.height)),
            ("inside_leg", Some(template.crotch)),
            ("armpit_height", template.armpit),
        ] {
            let asked = known
                .iter()
                .any(|(k, m)| k == name && m.origin == Origin::Asked);
            if let (Some(value), false) = (value, asked) {
                (known.set(name, value, Origin::Asked))
                    .map_err(|error| BodyError::Description(error.to_string()))?;
            }
        }
        let request = Request::read(&known, figure)?;
        let warp = Warp::still(&template_body.template, &template_body.marks);
        let levels = levels::solve(&request, &template_body.marks, &SkinOffsets::default());
        let mesh = template_body.skin.mesh.clone();
        Ok(Self::with(
            (measurements, figure, request),
            template_body,
            (levels, warp),
            mesh,
        ))
    }

    fn grown(
        measurements: &Measurements,
        figure: Figure,
        template_body: Arc<TemplateBody>,
    ) -> Result<Self, BodyError> {
        let input = SolveInput {
            template: &template_body.template,
            skin: &template_body.skin,
            marks: template_body.marks,
            request: Request::read(measurements, figure)?,
        };
        let Solved {
            shape,
            levels,
            mesh,
        } = input.solve()?;
        let warp = Warp::new(&template_body.template, &template_body.marks, shape);
        let request = input.request;
        Ok(Self::with(
            (measurements, figure, request),
            template_body,
            (levels, warp),
            mesh,
        ))
    }

    fn with(
        (measurements, figure, request): (&Measurements, Figure, Request),
        template_body: Arc<TemplateBody>,
        (levels, warp): (Levels, Warp),
        skin: TriangleMesh,
    ) -> Self {
        let input = SolveInput {
            template: &template_body.template,
            skin: &template_body.skin,
            marks: template_body.marks,
            request,
        };
        let skeleton = hung(
            bones::skeleton(&template_body.template, &warp),
            &skin,
            &template_body.skin.arm,
        );
        let form = (figure == Figure::DressForm).then(|| {
            let neck = warp.apply(template_body.marks.neck.middle, Follow::default());
            let (sin, cos) = NECK_TILT.sin_cos();
            DressForm::of(
                (&skin, &template_body.skin.parts),
                [neck, Vec3::new(0.0, cos, sin)],
                levels.at(Level::Crown),
            )
        });
        Self {
            figure,
            measurements: measurements.clone(),
            skeleton,
            form,
            landmarks: Landmarks::find(&input, (&levels, &warp), &skin),
            crotch: input.crotch_vertices(),
            request: input.request,
            levels,
            warp,
            whole: skin,
            tree: OnceLock::new(),
            skinning: OnceLock::new(),
            primitives: OnceLock::new(),
            field: OnceLock::new(),
            template_body,
        }
    }

    /// The template's primitives mapped by the warp, scaled to lie on the skin, and fixed to joints.
    fn fitted_primitives(&self) -> Vec<AttachedPrimitive> {
        let template = &self.template_body.template;
        let own: Vec<Primitive> = template
            .primitives
            .iter()
            .filter(|primitive| !primitive.is_right())
            .copied()
            .collect();
        let attached = |(primitive, (k, is_image)): (&Primitive, (usize, bool))| {
            let side = |joint: Joint| if is_image { joint.mirrored() } else { joint };
            let particular = template.rigging.of(k);
            let asked = particular.and_then(|p| p.joint);
            let joint = asked.unwrap_or_else(|| bones::joint_of(template, &own[k]));
            let deformation = particular.and_then(|p| p.deformation.as_ref());
            AttachedPrimitive {
                deformation: deformation.map(|d| match is_image {
                    true => d.mirrored(),
                    false => d.clone(),
                }),
                ..AttachedPrimitive::new(side(joint), primitive, &self.skeleton)
            }
        };
        let sources = sources(&own);
        if self.warp.is_still() {
            let all = template.primitives.iter();
            return all.zip(sources).map(attached).collect();
        }
        let left: Vec<Primitive> = own
            .iter()
            .map(|primitive| {
                let mut body = carried(primitive, &self.warp);
                if primitive.is_central() {
                    body.centre[0] = 0.0;
                    body.rotation[1] = 0.0;
                    body.rotation[2] = 0.0;
                }
                body
            })
            .collect();
        refitted(left, &self.whole, &self.template_body.skin.parts)
            .iter()
            .zip(sources)
            .map(attached)
            .collect()
    }

    /// The weights with which the skin follows the joints.
    pub(crate) fn skinning(&self) -> &Skinning {
        self.skinning.get_or_init(|| {
            let positions = &self.skin().positions;
            if self.form.is_some() {
                return Skinning::rigid(positions.len());
            }
            let follow = &self.template_body.skin;
            let of_height = (&self.skeleton, self.landmarks.crown.y);
            Skinning::new(of_height, positions, [&follow.arm, &follow.leg])
        })
    }

    /// The figure that the body was grown from.
    pub fn figure(&self) -> Figure {
        self.figure
    }

    /// The requested measurements.
    pub fn measurements(&self) -> &Measurements {
        &self.measurements
    }

    /// The requested measurements with predictions of the others, each marked.
    pub fn completed(&self) -> &Measurements {
        &self.request.table
    }

    /// The skin: closed, oriented outwards. For whole bodies of a figure its triangles are the same for every
    /// set of measurements. The skin of a dress form includes its stand.
    pub fn skin(&self) -> &TriangleMesh {
        self.form.as_ref().map_or(&self.whole, |form| &form.mesh)
    }

    /// The dress form, if the body is one.
    pub(crate) fn form(&self) -> Option<&DressForm> {
        self.form.as_ref()
    }

    /// The skin with its box tree, built when first used.
    pub fn skin_tree(&self) -> &SurfaceTree {
        self.tree
            .get_or_init(|| SurfaceTree::new(self.skin().clone()))
    }

    /// The part of each triangle of the skin.
    pub fn part_of_triangle(&self) -> &[Part] {
        match &self.form {
            Some(form) => &form.parts,
            None => &self.template_body.skin.parts,
        }
    }

    /// The joints in their rest positions.
    pub fn skeleton(&self) -> &Skeleton {
        &self.skeleton
    }

    /// The ellipsoid primitives of the body, each in the frame of the joint that it is fixed to: a coarse
    /// description of the body. They are mapped from the template's primitives by the map of the skin and
    /// scaled to lie on the skin. A dress form has those of the whole body.
    pub fn primitives(&self) -> &[AttachedPrimitive] {
        self.primitives.get_or_init(|| self.fitted_primitives())
    }

    /// The primitives in the body's frame, at rest, in the order of [`Mannequin::primitives`].
    pub fn ellipsoids(&self) -> Vec<Primitive> {
        self.posed_ellipsoids(&Pose::rest())
    }

    /// The primitives in the body's frame, in a pose, each moved by its joint.
    pub fn posed_ellipsoids(&self, pose: &Pose) -> Vec<Primitive> {
        posed(self.primitives(), &self.skeleton, pose)
    }

    /// The implicit surface of the primitives at rest.
    pub fn field(&self) -> &Field {
        self.field.get_or_init(|| Field::new(&self.ellipsoids()))
    }

    /// Named points of the body.
    pub fn landmarks(&self) -> &Landmarks {
        &self.landmarks
    }

    /// Whether a point lies inside the skin. Exact.
    pub fn contains(&self, point: Vec3) -> bool {
        self.skin_tree().contains(point)
    }

    /// The closest point of the skin. Exact up to rounding; `None` for a point that is not finite.
    pub fn closest_point(&self, point: Vec3) -> Option<ClosestPoint> {
        self.skin_tree().closest_point(point, f64::INFINITY)
    }
}

/// The skeleton with the steepest angle at which its arms can hang.
fn hung(skeleton: Skeleton, mesh: &TriangleMesh, arm: &[f64]) -> Skeleton {
    let shoulder = skeleton.centre(Joint::LShoulder);
    let along = skeleton.centre(Joint::LWrist) - shoulder;
    let down = (-along.y).atan2(along.x);
    let steepest = hang(&mesh.positions, arm, (shoulder, down));
    skeleton.hanging(steepest)
}

/// A primitive mapped by the warp: its visible axes are mapped, and the left singular vectors and the
/// singular values of the result give the directions and the lengths of the new axes.
fn carried(primitive: &Primitive, warp: &Warp) -> Primitive {
    let follow = match primitive.part {
        Part::LeftArm | Part::RightArm => Follow::ARM,
        Part::LeftLeg | Part::RightLeg => Follow::LEG,
        Part::Trunk | Part::Head => Follow::default(),
    };
    let centre = Vec3::from(primitive.centre);
    let old = *primitive.rotation().matrix();
    let scaled = old * nalgebra::Matrix3::from_diagonal(&Vec3::from(primitive.radii));
    // Computed over the visible axes, as the map varies across the primitive.
    let axes = warp.carried_axes(centre, scaled * VISIBLE_RATIO, follow) / VISIBLE_RATIO;
    let svd = axes.svd(true, false);
    let (Some(vectors), values) = (svd.u, svd.singular_values) else {
        return *primitive;
    };
    // Each new axis replaces the old one that it is nearest to.
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
        centre: warp.apply(centre, follow).into(),
        radii: order.map(|k| values[k]),
        rotation: Rotation3::from_matrix_unchecked(axes).scaled_axis().into(),
        ..*primitive
    }
}
