//! Measurements asked for beside those taken from the finished skin.

use crate::Mannequin;
use crate::conflict::Conflict;
use crate::girths::Girth;
use crate::measured::TapedSkin;
use crate::tape::Skinned;
use toile_measure::{Origin, definition, is_angle};

/// A measurement as requested or predicted, and as taken from the skin by our own tape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviation {
    /// The measurement's name.
    pub name: &'static str,
    /// Requested or predicted value (m) or (rad).
    pub asked: f64,
    /// Value taken from the skin (m) or (rad).
    pub got: f64,
    /// Whether the measurement was requested or predicted from others.
    pub origin: Origin,
}

impl Deviation {
    /// Value taken from the skin minus the requested or predicted value (m) or (rad).
    pub fn deviation(&self) -> f64 {
        self.got - self.asked
    }

    /// Whether the measurement is a girth by a closed tape.
    pub fn is_girth(&self) -> bool {
        Girth::ALL.iter().any(|girth| girth.name() == self.name)
    }

    /// Whether the measurement is an angle.
    pub fn is_angle(&self) -> bool {
        is_angle(self.name)
    }
}

/// Largest deviation of a length as a share of stature that is not reported: a millimetre of an adult.
const NAMED: f64 = 5.7e-4;
impl Mannequin {
    /// Calls a function with the tape on the finished skin.
    pub(crate) fn with_tape<T>(&self, use_it: impl FnOnce(&TapedSkin) -> T) -> T {
        let skinned = Skinned::finished(&self.whole, &self.template_body.skin.parts);
        use_it(&TapedSkin::new(
            &skinned,
            (&self.template_body.marks, &self.template_body.skin.armpit),
            (&self.levels, &self.warp),
            &self.crotch,
        ))
    }

    /// A measurement by its name in the catalogue, taken from the finished skin (m) or (rad); `None` if the
    /// tape cannot take it.
    pub fn taken(&self, name: &str) -> Option<f64> {
        let name = definition(name).map_or(name, |known| known.name);
        self.with_tape(|tape| tape.value(name))
    }

    /// Every measurement that the body was made from, as requested or predicted and as the finished skin has
    /// it; requested ones first. Girths are those of the convex hull of a section: level round trunk and
    /// legs, across arms and neck. Lengths over the body lie tight on it.
    pub fn measure(&self) -> Vec<Deviation> {
        self.with_tape(|tape| {
            let mut rows = Vec::new();
            for origin in [Origin::Asked, Origin::Predicted] {
                for (name, measured) in self.request.table.iter() {
                    let (Some(known), true) = (definition(name), measured.origin == origin) else {
                        continue;
                    };
                    if let Some(got) = tape.value(known.name) {
                        rows.push(Deviation {
                            name: known.name,
                            asked: measured.value,
                            got,
                            origin,
                        });
                    }
                }
            }
            rows
        })
    }

    /// Names of requested measurements that the tape cannot take.
    pub fn untaken(&self) -> Vec<String> {
        let known: Vec<&str> = self.measure().iter().map(|gap| gap.name).collect();
        self.request
            .table
            .iter()
            .filter(|(name, m)| m.origin == Origin::Asked && !known.contains(name))
            .map(|(name, _)| name.to_owned())
            .collect()
    }

    /// Contradictions among the requested measurements: those that break a rule for any body, and those that
    /// the solved body misses by more than a millimetre at the size of an adult, or by 0.02 rad.
    pub fn conflicts(&self) -> Vec<Conflict> {
        let mut found = self.request.conflicts.clone();
        let height = self.request.get("height");
        for row in self.measure() {
            let beyond = match row.is_angle() {
                true => row.deviation().abs() > 0.02,
                false => row.deviation().abs() > NAMED * height,
            };
            let mut named = false;
            for conflict in &mut found {
                if row.origin == Origin::Asked && conflict.names.contains(&row.name) {
                    if conflict.is_angle() == row.is_angle() {
                        conflict.gap = conflict.gap.max(row.deviation().abs());
                    }
                    named = true;
                }
            }
            if row.origin == Origin::Asked && beyond && !named {
                found.push(Conflict {
                    names: vec![row.name],
                    gap: row.deviation().abs(),
                    why: "the body that meets the others best does not have it: measure it anew, \
                          or those beside it",
                });
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use crate::definitions::Taping;
    use crate::girths::Girth;
    use crate::measured::TapedSkin;
    use crate::tape::Skinned;
    use crate::{Figure, Mannequin};
    use toile_measure::{Measurements, Origin};

    /// Reading of a tape that searches only near its position, minus its reading on the whole skin (m).
    fn gaps(body: &Mannequin) -> Vec<(&'static str, f64)> {
        let skin = &body.template_body.skin;
        let place = |v: usize| body.whole.positions[v];
        let near = Skinned::lazy((&skin.mesh, &skin.bands), &skin.parts, &place);
        let near = TapedSkin::new(
            &near,
            (&body.template_body.marks, &skin.armpit),
            (&body.levels, &body.warp),
            &body.crotch,
        );
        let girths = Girth::ALL.into_iter();
        girths
            .map(|girth| {
                let whole = body.with_tape(|tape| tape.girth(girth));
                (girth.name(), near.girth(girth) - whole)
            })
            .filter(|(_, gap)| gap.abs() > 1e-9)
            .collect()
    }

    #[test]
    fn a_tape_that_looks_near_its_place_reads_what_it_reads_on_the_whole_skin() {
        let average = Mannequin::new(&Figure::Man.average(), Figure::Man).unwrap();
        let average = average.completed();
        // Arms, necks and trunks at the extremes of human sizes.
        for (figure, height, share) in [
            (Figure::Woman, 1.45, 0.8),
            (Figure::Woman, 1.85, 1.5),
            (Figure::Man, 1.55, 1.4),
            (Figure::Man, 2.05, 0.85),
            (Figure::Child4, 1.0, 1.0),
        ] {
            let mut table = Measurements::new();
            table.set("height", height, Origin::Asked).unwrap();
            if share != 1.0 {
                for name in ["bust", "waist", "hips", "neck", "upper_arm", "forearm"] {
                    let usual = average.get(name).unwrap() * height / 1.76;
                    table.set(name, usual * share, Origin::Asked).unwrap();
                }
            }
            let body = Mannequin::new(&table, figure).unwrap();
            assert_eq!(gaps(&body), [], "{figure:?} {height} {share}");
        }
    }

    #[test]
    fn an_elbow_larger_than_the_forearm_leaves_no_thread_below_it() {
        let mut asked = Measurements::new();
        for (name, value) in [
            ("upper_arm", 0.33),
            ("elbow", 0.30),
            ("forearm", 0.27),
            ("wrist", 0.16),
            ("arm_length", 0.61),
            ("shoulder_to_elbow", 0.34),
        ] {
            asked.set(name, value, Origin::Asked).unwrap();
        }
        let body = Mannequin::new(&asked, Figure::Mean).unwrap();
        let slices: Vec<f64> = body.with_tape(|tape| {
            let taping = Taping::of(Girth::Forearm, tape.body()).unwrap();
            let slice = |k: u32| tape.taped(&taping, taping.at(0.1 * f64::from(k)));
            (0..=10).map(slice).collect()
        });
        // It tapers from the elbow's girth towards the wrist's.
        let tapers = slices.windows(2).all(|w| w[1] < w[0] + 1e-3);
        assert!(tapers && slices[5] > 0.2 && slices[10] > 0.16, "{slices:?}");
        // A tape at the elbow's end finds more than is asked for, and that is said.
        let said = body.conflicts().into_iter().flat_map(|c| c.names);
        assert_eq!(said.collect::<Vec<_>>(), ["forearm"]);
    }
}
