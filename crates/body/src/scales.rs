//! The scales that a body is solved for.

use crate::girths::PerGirth;
use crate::shape::{BustForm, CrotchForm};
use crate::template_marks::TemplateMarks;

/// Unknowns of the solution, by the parts of the body.
#[derive(Clone, Debug)]
pub(crate) struct Scales {
    /// Scale of each girth.
    pub(crate) girth: PerGirth<f64>,
    pub(crate) trunk: TrunkScales,
    pub(crate) neck: NeckScales,
    pub(crate) shoulder: ShoulderScales,
    pub(crate) bust: BustForm,
    pub(crate) crotch: CrotchForm,
    pub(crate) arm: ArmScales,
}

/// Form of the trunk's sections at a given girth.
#[derive(Clone, Debug)]
pub(crate) struct TrunkScales {
    /// Form of the sections of girths round the trunk.
    pub(crate) section: PerGirth<SectionForm>,
    /// Amount by which the front corners of the chest are fuller, and the back ones less full (1).
    pub(crate) chest_asymmetry: f64,
    /// Scale at the crotch divided by the scale at the hips (1): less than 1 if otherwise a section below the
    /// hips had a larger girth than the hips.
    pub(crate) crotch_to_hips: f64,
}

/// The form of a section of the trunk.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SectionForm {
    /// Lateral scale divided by frontal scale (1).
    pub(crate) aspect: f64,
    /// Amount by which the corners are fuller (1).
    pub(crate) corner_fullness: f64,
    /// Share of the frontal scale that the front has, minus one half.
    pub(crate) front_share: f64,
    /// Depth of the side lines, which divide the girth into front and back (m).
    pub(crate) side_depth: f64,
}

/// Scales of the neck.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NeckScales {
    /// Lateral scale at the sides of the neck.
    pub(crate) breadth: f64,
    /// Distance by which the neck stands forward of the neck of the template (m).
    pub(crate) forward: f64,
}

/// Scales of the shoulders.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShoulderScales {
    /// Lateral scale at the outer ends of the shoulders.
    pub(crate) breadth: f64,
    /// Rise of the armpits above the height given by the levels (m).
    pub(crate) armpit_rise: f64,
}

/// Lengths of the arm: distances from the shoulder joint along the arm (m).
#[derive(Clone, Copy, Debug)]
pub(crate) struct ArmScales {
    pub(crate) elbow: f64,
    pub(crate) wrist: f64,
}

impl Scales {
    /// Scales to start from: those of the template for a body with a ratio of statures, body to template.
    pub(crate) fn new(stature_ratio: f64, marks: &TemplateMarks) -> Self {
        let section = SectionForm {
            aspect: 1.0,
            corner_fullness: 0.0,
            front_share: 0.0,
            side_depth: 0.0,
        };
        Self {
            girth: PerGirth::of(|_| stature_ratio),
            trunk: TrunkScales {
                section: PerGirth::of(|_| section),
                chest_asymmetry: 0.0,
                crotch_to_hips: 1.0,
            },
            neck: NeckScales {
                breadth: stature_ratio,
                forward: 0.0,
            },
            shoulder: ShoulderScales {
                breadth: stature_ratio,
                armpit_rise: 0.0,
            },
            bust: BustForm::default(),
            crotch: CrotchForm::default(),
            arm: ArmScales {
                elbow: stature_ratio * marks.arm.elbow,
                wrist: stature_ratio * marks.arm.wrist,
            },
        }
    }

    /// Unknowns that influence one another and so converge slowly; they are extrapolated together.
    pub(crate) fn coupled(&mut self) -> impl Iterator<Item = &mut f64> {
        let single = [
            &mut self.shoulder.breadth,
            &mut self.neck.breadth,
            &mut self.neck.forward,
            &mut self.bust.spread,
            &mut self.shoulder.armpit_rise,
            &mut self.bust.projection,
            &mut self.crotch.flatness,
            &mut self.trunk.crotch_to_hips,
        ];
        self.girth.iter_mut().chain(single)
    }
}
