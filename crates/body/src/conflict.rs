//! Contradictions: measurements that no single body has together.

use std::f64::consts::SQRT_2;
use toile_measure::{Measurements, Origin, is_angle};

/// Measurements that contradict one another. The body meets them in the sense of least squares.
#[derive(Clone, Debug, PartialEq)]
pub struct Conflict {
    /// The measurements, by their names.
    pub names: Vec<&'static str>,
    /// Size of the disagreement (m); of an angle (rad).
    pub gap: f64,
    /// Reason for the contradiction, and the change to make.
    pub why: &'static str,
}

impl Conflict {
    /// Whether the disagreement is one of angles.
    pub fn is_angle(&self) -> bool {
        self.names.iter().all(|name| is_angle(name))
    }
}

/// A sum of measurements (m) that on any body is at least a share of the stature: names with their factors,
/// the share, and the message if it is less.
type Rule = (&'static [(&'static str, f64)], f64, &'static str);

/// Rules that follow from the meaning of the measurements and from the shapes of people. A straight tape down
/// the front is no longer than the way over the bust, unless a belly stands farther out or the front falls
/// flatter than 45 degrees below the bust. A length along the skin is at least its drop in height.
const RULES: &[Rule] = &[
    (
        &[("bust", 1.0), ("high_bust", -1.0)],
        0.0,
        "the high bust is larger than the bust, which is the largest girth of the chest: measure \
         both anew",
    ),
    (
        &[("bust", 1.0), ("underbust", -1.0)],
        0.0,
        "the girth under the bust is larger than the bust: measure both anew",
    ),
    (
        &[("underbust", 1.35), ("waist", -1.0)],
        0.0,
        "the waist has over 1.35 of the girth under the bust, where it is the smallest girth below \
         it: measure both anew",
    ),
    (
        &[("underbust", 0.55), ("hips", 0.55), ("waist", -1.0)],
        0.0,
        "the waist is far larger than the girth under the bust and the hips, where it is the \
         smallest girth between them: measure all three anew",
    ),
    (
        &[("hips", 1.0), ("high_hips", -1.0)],
        0.0,
        "the high hips are larger than the hips, which are the largest girth there: measure both \
         anew",
    ),
    (
        &[("high_hips", 1.0), ("waist", -1.0), ("hips", -0.15)],
        -0.12,
        "the high hips are far under the waist: measure both anew",
    ),
    (
        &[
            ("bust_line", 1.0),
            ("bust_to_underbust", 1.0),
            ("waist_to_underbust", SQRT_2),
            ("hps_to_waist_front", -1.0),
        ],
        0.0,
        "the way over the bust to the waist is shorter than the straight one: measure them anew",
    ),
    (
        &[
            ("vert_bust_line", 1.0),
            ("bust_to_underbust", 1.0),
            ("waist_to_underbust", 1.0),
            ("waist_line", -1.0),
        ],
        0.0,
        "the way from the bust to the level under it is shorter than its fall: measure it anew, or \
         the lengths from nape to bust and waist",
    ),
    (
        &[
            ("height", 1.0),
            ("head_l", -1.0),
            ("waist_line", -1.0),
            ("hips_line", -1.0),
            ("crotch_hip_diff", -1.0),
        ],
        0.36,
        "height less head_l, waist_line, hips_line and crotch_hip_diff leaves legs shorter than \
         0.36 of the height: lessen one of them",
    ),
    (
        &[("waist_line", 1.0), ("vert_bust_line", -1.0)],
        0.05,
        "the bust level must lie above the waist by 0.05 of the height or more: lessen \
         vert_bust_line",
    ),
    (
        &[("hips", 0.72), ("leg_circ", -1.0)],
        0.0,
        "a thigh cannot have over 0.72 of the hip girth: lessen leg_circ",
    ),
    (
        &[("leg_circ", 1.0), ("calf", -1.0)],
        0.0,
        "the calf is larger than the thigh: measure both anew",
    ),
    (
        &[("upper_arm", 1.0), ("wrist", -1.0)],
        0.0,
        "the wrist is larger than the upper arm: measure both anew",
    ),
    (
        &[("heel", 1.0), ("ankle", -1.0)],
        0.0,
        "the ankle is larger than heel and instep: measure both anew",
    ),
];

/// Lengths that add up to zero on any body: names with signs, and the message if they do not.
type Loop = (&'static [(&'static str, f64)], &'static str);

const LOOPS: &[Loop] = &[
    (
        &[("bust", 1.0), ("front_width", -1.0), ("back_width", -1.0)],
        "the parts of the bust girth before and behind the side lines do not add up to it: change \
         one of them",
    ),
    (
        &[
            ("height", 1.0),
            ("head_l", -1.0),
            ("waist_line", -1.0),
            ("hips_line", -1.0),
            ("crotch_hip_diff", -1.0),
            ("inside_leg", -1.0),
        ],
        "height, head, waist, hips, crotch and leg lengths do not add up: change one of them",
    ),
    (
        &[
            ("waist_height", 1.0),
            ("waist_to_crotch", -1.0),
            ("inside_leg", -1.0),
        ],
        "waist height is not the rise and the inside leg together: change one of them",
    ),
    (
        &[("height", 1.0), ("head_l", -1.0), ("nape_height", -1.0)],
        "the nape's height is not stature less head and neck: change one of them",
    ),
    (
        &[
            ("nape_height", 1.0),
            ("waist_line", -1.0),
            ("waist_height", -1.0),
        ],
        "the back length is not the way from nape to waist: change one of them",
    ),
    (
        &[
            ("waist_height", 1.0),
            ("waist_to_knee", -1.0),
            ("knee_height", -1.0),
        ],
        "the knee's height is not that of the waist less the way to the knee: change one of them",
    ),
    (
        &[
            ("waist_height", 1.0),
            ("hips_line", -1.0),
            ("hip_height", -1.0),
        ],
        "the hips' height is not that of the waist less the way to the hips: change one of them",
    ),
    (
        &[
            ("nape_height", 1.0),
            ("vert_bust_line", -1.0),
            ("bust_height", -1.0),
        ],
        "the bust's height is not that of the nape less its depth: change one of them",
    ),
];

/// Disagreement that is not reported, as a share of stature: the accuracy of the tape.
const SLACK: f64 = 5e-4;

/// Whether `name` is [`UNDER_BUST`] and contradicts other measurements: it then has little weight and does
/// not determine how far the bust stands out.
pub(crate) fn gives_way(name: &str, conflicts: &[Conflict]) -> bool {
    let among = |c: &Conflict| c.names.contains(&UNDER_BUST);
    name == UNDER_BUST && conflicts.iter().any(among)
}

/// Measurement of the front that also passes over a belly.
const OVER_BELLY: &str = "hps_to_waist_front";

/// Measurement that has little weight if it contradicts others.
const UNDER_BUST: &str = "bust_to_underbust";

/// A conflict for every rule that the requested measurements break.
pub(crate) fn conflicts(table: &Measurements) -> Vec<Conflict> {
    let height = table.get("height").unwrap_or(1.7);
    // Only requested measurements can contradict each other.
    let sum = |terms: &[(&'static str, f64)]| -> Option<f64> {
        terms.iter().try_fold(0.0, |sum, (name, sign)| {
            let measured = table.measured(name)?;
            (measured.origin == Origin::Asked).then_some(sum + sign * measured.value)
        })
    };
    let names = |terms: &[(&'static str, f64)]| terms.iter().map(|term| term.0).collect();
    let mut found = Vec::new();
    // Over a belly the straight length of the front may be longer than the way over the bust.
    let belly = table.get("waist") > table.get("underbust");
    let over_belly = |terms: &[(&str, f64)]| belly && terms.iter().any(|t| t.0 == OVER_BELLY);
    for &(terms, share, why) in RULES {
        if let Some(sum) = sum(terms)
            && !over_belly(terms)
            && sum < share * height - SLACK * height
        {
            found.push(Conflict {
                names: names(terms),
                gap: share * height - sum,
                why,
            });
        }
    }
    for &(terms, why) in LOOPS {
        if let Some(sum) = sum(terms)
            && sum.abs() > SLACK * height
        {
            found.push(Conflict {
                names: names(terms),
                gap: sum.abs(),
                why,
            });
        }
    }
    found
}
