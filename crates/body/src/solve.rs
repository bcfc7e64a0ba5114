//! The shape whose skin has the measurements asked for.

use crate::marks::{Marks, UNDERBUST};
use crate::request::Request;
use crate::rings::TemplateSkin;
use crate::tape::{girth, girth_across, ridge};
use crate::template::Template;
use crate::warp::{Follow, Shape, Warp};
use crate::{BodyError, Part};
use toile_geometry::{TriangleMesh, Vec3};

/// Height of the neck's side below the nape, over stature.
pub(crate) const NECK_SIDE_DROP: f64 = 0.020;
/// Depth below the crotch at which the thigh is measured, over stature.
pub(crate) const THIGH_DROP: f64 = 0.012;

/// Scales that are solved for, in the order in which a tape would find them.
#[derive(Clone, Copy, Debug)]
struct Scales {
    hips: f64,
    waist: f64,
    underbust: f64,
    bust: f64,
    shoulder: f64,
    neck: f64,
    thigh: f64,
    wrist: f64,
    arm_length: f64,
    /// Height of the neck's side over the shoulder's end, over what its slope asks for.
    shoulder_drop: f64,
}

/// A template with its skin and marks.
pub(crate) struct Grown<'a> {
    pub(crate) template: &'a Template,
    pub(crate) skin: &'a TemplateSkin,
    pub(crate) marks: Marks,
    pub(crate) request: Request,
}

impl Grown<'_> {
    /// Finds the shape by fixed-point iteration: each scale is multiplied by asked over got.
    pub(crate) fn solve(&self) -> Result<(Shape, TriangleMesh), BodyError> {
        let global = self.request.height / self.template.height;
        let mut scales = Scales {
            hips: global,
            waist: global,
            underbust: global,
            bust: global,
            shoulder: 0.5 * self.request.shoulder_width / self.marks.tip.x,
            neck: 0.5 * self.request.neck_width / self.marks.neck_side.x,
            thigh: global,
            wrist: global,
            arm_length: global,
            shoulder_drop: 1.0,
        };
        /// Sections interact only through the curves between levels: twelve rounds reach 1e-5.
        const ROUNDS: usize = 12;
        for _ in 0..ROUNDS {
            let shape = self.shape(&scales)?;
            let mesh = self.skin_of(&shape);
            self.correct(&mut scales, &shape, &mesh);
        }
        let shape = self.shape(&scales)?;
        let mesh = self.skin_of(&shape);
        Ok((shape, mesh))
    }

    fn correct(&self, scales: &mut Scales, shape: &Shape, mesh: &TriangleMesh) {
        let (q, parts) = (&self.request, &self.skin.parts);
        let trunk = |asked: f64, level: f64| ratio(asked, girth(mesh, parts, Part::Trunk, level));
        scales.hips *= trunk(q.hips, q.hip_level());
        scales.waist *= trunk(q.waist, q.waist_level());
        scales.bust *= trunk(q.bust, q.bust_level());
        scales.underbust *= trunk(q.underbust, q.bust_level() - UNDERBUST * q.height);
        let thigh = q.crotch_level() - THIGH_DROP * q.height;
        scales.thigh *= ratio(q.thigh, girth(mesh, parts, Part::LeftLeg, thigh));
        let warp = Warp::new(self.template, shape.clone());
        let [wrist, along] = self.wrist(&warp);
        scales.wrist *= ratio(
            q.wrist,
            girth_across(mesh, parts, Part::LeftArm, [wrist, along]),
        );
        let window = [q.bust_level(), q.nape() + 0.02 * q.height];
        if let Some(tip) = ridge(mesh, 0.5 * q.shoulder_width, window) {
            scales.arm_length *= ratio(q.arm_length, (wrist - tip).dot(&along));
            let neck = warp.apply(self.marks.neck_side, Follow::default());
            let slope = (neck.y - tip.y) / (neck.x - tip.x).abs();
            // Half steps: the blend with the arm answers late.
            scales.shoulder_drop *= ratio(q.shoulder_slope.tan(), slope).clamp(0.5, 2.0).sqrt();
        }
    }

    /// Centre of the wrist and direction of the arm on the body.
    pub(crate) fn wrist(&self, warp: &Warp) -> [Vec3; 2] {
        let on_arm = Follow { arm: 1.0, leg: 0.0 };
        let wrist = warp.apply(Vec3::from(self.template.joints.wrist), on_arm);
        let shoulder = warp.apply(Vec3::from(self.template.joints.shoulder), on_arm);
        [wrist, (wrist - shoulder).normalize()]
    }

    fn shape(&self, s: &Scales) -> Result<Shape, BodyError> {
        let (m, q, t) = (&self.marks, &self.request, self.template);
        let global = q.height / t.height;
        let neck_level = q.nape() - NECK_SIDE_DROP * q.height;
        let tip_level = neck_level
            - s.shoulder_drop * 0.5 * (q.shoulder_width - q.neck_width) * q.shoulder_slope.tan();
        if tip_level < q.bust_level() + 0.03 * q.height {
            return Err(BodyError::Contradiction {
                first: "shoulder_incl",
                second: "vert_bust_line",
                remedy: "the shoulders fall to the level of the bust: lessen shoulder_incl or \
                         enlarge vert_bust_line",
            });
        }
        let crotch = q.crotch_level();
        let levels = vec![
            [0.0, 0.0],
            [t.joints.ankle[1], t.joints.ankle[1] * global],
            [t.joints.knee[1], t.joints.knee[1] * crotch / m.crotch],
            [m.crotch, crotch],
            [m.bust, q.bust_level()],
            [m.tip.y, tip_level],
            [m.neck_side.y, neck_level],
            [m.crown, q.height],
        ];
        // Between crotch and bust heights are stretched evenly, so the levels follow.
        let stretch = (m.bust - m.crotch) / (q.bust_level() - crotch);
        let on_template = |level: f64| m.crotch + (level - crotch) * stretch;
        let hips = on_template(q.hip_level());
        let waist = on_template(q.waist_level());
        let underbust = on_template(q.bust_level() - UNDERBUST * q.height);
        let head = (q.height - neck_level) / (m.crown - m.neck_side.y);
        let chin = m.neck_side.y + 0.35 * (m.crown - m.neck_side.y);
        let girths = |tip: f64, neck: f64| {
            vec![
                [m.crotch, s.hips],
                [hips, s.hips],
                [waist, s.waist],
                [underbust, s.underbust],
                [m.bust, s.bust],
                [m.tip.y, tip],
                [m.neck_side.y, neck],
                [chin, head],
                [m.crown, head],
            ]
        };
        let wrist = (Vec3::from(t.joints.wrist) - Vec3::from(t.joints.shoulder)).norm();
        Ok(Shape {
            levels,
            lateral: girths(s.shoulder, s.neck),
            frontal: girths(0.5 * (s.bust + global), 0.5 * (s.neck + global)),
            leg: vec![
                [0.0, global],
                [t.joints.ankle[1], global],
                [t.joints.knee[1], 0.5 * (global + s.thigh)],
                [m.crotch - THIGH_DROP * t.height, s.thigh],
                [hips, s.thigh],
            ],
            arm: vec![
                [0.0, global],
                [0.5 * wrist, 0.5 * (global + s.wrist)],
                [wrist, s.wrist],
                [1.1 * wrist, s.wrist],
                [1.3 * wrist, global],
            ],
            arm_length: s.arm_length,
            arm_angle: q.arm_angle,
            global,
            stance: s.hips,
            depth: m.depth,
        })
    }

    /// The template's skin carried to a shape, exactly symmetric.
    fn skin_of(&self, shape: &Shape) -> TriangleMesh {
        let warp = Warp::new(self.template, shape.clone());
        let skin = self.skin;
        let mut mesh = skin.mesh.clone();
        for v in 0..mesh.positions.len() {
            let mirror = skin.mirror[v] as usize;
            if mirror < v {
                continue;
            }
            let follow = Follow {
                arm: skin.arm[v],
                leg: skin.leg[v],
            };
            let mut p = warp.apply(skin.mesh.positions[v], follow);
            if mirror == v {
                p.x = 0.0;
            } else if follow.leg > 0.5 {
                p.x = p.x.max(LEG_GAP);
            }
            mesh.positions[v] = p;
            if mirror != v {
                mesh.positions[mirror] = Vec3::new(-p.x, p.y, p.z);
            }
        }
        mesh
    }
}

/// Half the least gap between the legs [m]: cloth must pass.
const LEG_GAP: f64 = 0.003;

fn ratio(asked: f64, got: f64) -> f64 {
    if got > 0.0 { asked / got } else { 1.0 }
}
