//! Judges what a drape or the run of a scene came to: the verdict that reports, pictures, the window and the
//! exit status of the command tell.
//!
//! # Decided with
//! - [`toile_drape::Verdict`], [`toile_drape::Aspect`]: the verdict and its aspects;
//! - [`toile_drape::supports`], [`toile_drape::OpenAttachment`]: what carries the cloth; attachments that
//!   stay open;
//! - [`crate::crumple::short_seams`], [`crate::crossings::Crossings::warning`]: seams in a heap; crossings;
//! - [`toile_drape::GarmentRun`], [`crate::pace::Pace::follow`]: what a run says itself; its speed;
//! - [`toile_drape::Measures`]: penetration, strain, residual;
//! - [`crate::report::Report`], [`crate::scene`] (`report`), [`crate::pictures::drape_png`],
//!   [`crate::event::Draped`]: who tells it: reports, pictures, events;
//! - [`crate::setup`] (`counted`): gathers, whose strain is not counted.
//!
//! As exit status: crate `cli`, `output.rs`. In the window: `app/garment_pane.rs`.

use crate::crossings::Crossings;
use crate::crumple::short_seams;
use crate::{GarmentJob, GarmentPart};
use std::collections::BTreeSet;
use toile_drape::{
    Aspect, AttachmentEnd, Finding, GarmentRun, Measures, OpenAttachment, SceneRun, Stage, Support,
    Verdict, Workspace, stretch_per_triangle, supports,
};
use toile_geometry::Vec3;

/// Stretch beyond which a garment is called too tight (1): a knit stretches up to this much without strain on
/// the wearer.
const TIGHT: f64 = 0.15;
/// Depth of cloth in the body up to which cloth that is too tight counts as pressed in, and not as passed
/// through (m).
const PRESSED: f64 = 0.03;
/// Depth of a vertex inside a solid beyond which the cloth is judged to have passed through (m): cloth that
/// only presses on the solid sinks in less.
const THROUGH: f64 = 0.01;
/// Stretch of the cloth of a scene beyond which no cloth bears it (1): woven cloth tears long before.
const OVERSTRETCHED: f64 = 1.0;
/// Depth below the floor up to which a hem counts as only touching the floor (m).
const ON_FLOOR: f64 = 0.02;
/// Distance up to which cloth counts as touching the body, as a multiple of the contact offset (1).
const TOUCH: f64 = 1.5;
/// Largest number of names that a list spells out.
const MAX_NAMES: usize = 4;

/// Judges a garment at the present state of its run: at rest, or when its seams could not be closed.
pub(crate) fn of_garment(job: &GarmentJob, run: &GarmentRun, measures: &Measures) -> Verdict {
    let mut verdict = Verdict::default();
    let progress = run.progress();
    let is_sewn = progress.stage != Stage::Sewing;
    let open = (!is_sewn).then(|| {
        let words = format!(
            "seams are still {:.1} mm apart after {} steps of sewing: the garment may be too tight for the body, or a panel hangs behind it; check the measurements and the placement",
            progress.gap * 1e3,
            progress.step
        );
        Finding::bad(Aspect::Seams, words)
    });
    verdict.judge(Aspect::Seams, open);
    if is_sewn {
        verdict.judge(Aspect::Body, off_body(job, run));
        let remedy = match verdict.passes(Aspect::Body) {
            Some(false) => "what nothing carries cannot come to rest",
            _ => "panels placed nearer to where they hang, more ease, or another quality may help",
        };
        let (goal, steps) = (job.setup.rest.residual, run.steps()[1]);
        verdict.judge(Aspect::Rest, unrest(progress.residual, goal, steps, remedy));
        verdict.judge(Aspect::Length, None);
        let parts = run.system.mesh(&run.state.positions).component_count();
        verdict.judge(Aspect::Hang, crumpled(job, run));
        verdict.judge(Aspect::Parts, in_parts(parts, job.parts.len()));
    }
    verdict.judge(Aspect::Tangle, garment_tangle(run, measures));
    let remedy = "say where its panels are worn, so that they hang clear of arms and legs, or give it more ease (a larger size) where it is narrower than the body";
    let through = through_solid("the body", (measures, deepest_in_body(measures)), remedy);
    // The tightness of cloth on a body that passes through the cloth is meaningless.
    if through.is_none() {
        verdict.judge(Aspect::Tightness, tightness(measures));
    }
    verdict.judge(Aspect::Tangle, through);
    if !measures.layers.is_empty() {
        verdict.judge(Aspect::Layers, disorder(measures, &job.parts));
    }
    verdict.extend(run.findings().iter().cloned());
    verdict
}

/// Judges the run of a scene at its end.
pub(crate) fn of_scene(run: &SceneRun, measures: &Measures, crossings: &Crossings) -> Verdict {
    let mut verdict = Verdict::default();
    let settings = run.settings();
    if let Some(residual) = run.residual()
        && settings.method.kind.is_equilibrium()
    {
        let goal = settings.method.rest_residual();
        let falling = supports(&run.system, &run.state, &mut Workspace::default())
            .iter()
            .any(Support::falls);
        let remedy = match falling {
            true => "nothing holds a cloth, which falls for ever: pin it, or put a solid under it",
            false => {
                "give method.iterations more, a finer mesh, or let it swing out by a method in time first"
            }
        };
        verdict.judge(Aspect::Rest, unrest(residual, goal, run.steps(), remedy));
    }
    if !settings.method.kind.is_equilibrium() {
        verdict.judge(Aspect::Pace, None);
    }
    if run.split_steps() > 0 {
        let words = format!(
            "{} steps failed and were taken in smaller ones",
            run.split_steps()
        );
        verdict.judge(Aspect::Pace, [Finding::told(Aspect::Pace, words)]);
    }
    if run.world().attachments().next().is_some() {
        verdict.judge(Aspect::Seams, open_elastics(run));
    }
    let tangle = crossings.warning(run.system.contact.cloth_offset);
    verdict.judge(
        Aspect::Tangle,
        tangle.map(|words| Finding::bad(Aspect::Tangle, words)),
    );
    let remedy = match settings.method.kind.is_equilibrium() {
        true => "place it clear of the solid, or take a finer mesh",
        false => "place it clear of the solid, or take a finer mesh or a shorter step",
    };
    verdict.judge(
        Aspect::Tangle,
        through_solid("a solid", (measures, THROUGH), remedy),
    );
    verdict.judge(Aspect::Tightness, overstretched(measures));
    verdict
}

/// Finding on cloth of a scene that is stretched to more than twice its length.
fn overstretched(measures: &Measures) -> Option<Finding> {
    let [warp, weft] = measures.strain_max;
    let (name, strain) = match warp >= weft {
        true => ("warp", warp),
        false => ("weft", weft),
    };
    (strain > OVERSTRETCHED).then(|| {
        let words = format!(
            "cloth is stretched to {:.1} times its length along the {name} at the worst place, which no cloth bears: let what holds it move less far, or give its material more stiffness",
            1.0 + strain
        );
        Finding::told(Aspect::Tightness, words)
    })
}

/// Finding that the net force is above the goal that counts as rest.
fn unrest(residual: f64, goal: f64, steps: usize, remedy: &str) -> Option<Finding> {
    let at_rest = residual <= goal;
    (!at_rest).then(|| {
        let words = format!(
            "it did not come to rest: after {steps} steps the net force is {} the weight, above the {goal:.1e} asked for; {remedy}",
            force(residual)
        );
        Finding::bad(Aspect::Rest, words)
    })
}

/// Net force over weight in words that stand before "the weight"; a number if it is large.
fn force(residual: f64) -> String {
    match residual {
        many if many >= 1.0 => format!("{many:.1} times"),
        few => format!("{few:.1e} of"),
    }
}

/// Findings on parts of the garment that the body does not carry, or that reach below its feet.
fn off_body(job: &GarmentJob, run: &GarmentRun) -> Vec<Finding> {
    let grounds = job.setup.colliders.iter();
    let grounds = grounds.filter_map(|solid| Some(solid.mesh().bounds()?[0].y));
    let floor = grounds.fold(f64::INFINITY, f64::min);
    let reach = TOUCH * run.system.contact.offset;
    let all = supports(&run.system, &run.state, &mut Workspace::default());
    let lost = |part: &&Support| part.has_left(reach, floor) || part.falls();
    let fallen: Vec<&Support> = all.iter().filter(lost).collect();
    let mut found = Vec::new();
    if !fallen.is_empty() {
        let who = match fallen.len() == all.len() {
            true => "the garment".to_owned(),
            false => panels_of(job, run, &fallen),
        };
        let low = fallen.iter().map(|part| part.heights[1]);
        let depth = floor - low.fold(f64::NEG_INFINITY, f64::max);
        let place = match depth > 0.0 {
            true => format!("fell off the body, {depth:.2} m below the floor"),
            false => "falls off the body: nothing holds it".to_owned(),
        };
        let words = format!(
            "{who} {place}; place it where it is to hang (facing, wrap), and let it be as narrow as the body where it is to hold"
        );
        found.push(Finding::bad(Aspect::Body, words));
    }
    let worn = all.iter().filter(|part| !lost(part));
    let lowest = worn
        .map(|part| part.heights[0])
        .fold(f64::INFINITY, f64::min);
    if lowest < floor - ON_FLOOR {
        let words = format!(
            "it reaches {:.1} cm below the floor: it slid down, or is too long for this wearer",
            (floor - lowest) * 1e2
        );
        found.push(Finding::told(Aspect::Length, words));
    }
    found
}

/// Names of the panels that have cloth in some of the connected parts of the garment.
fn panels_of(job: &GarmentJob, run: &GarmentRun, parts: &[&Support]) -> String {
    let has = |v: usize| {
        let merged = run.target()[v];
        parts
            .iter()
            .any(|part| part.vertices.binary_search(&merged).is_ok())
    };
    let panels = job.garment.panels.iter();
    let names: Vec<String> = panels
        .filter(|panel| panel.vertices.clone().any(has))
        .map(|panel| format!("{:?}", panel.name))
        .collect();
    listed(&names)
}

/// Names in a row, the first few spelt out.
fn listed(names: &[String]) -> String {
    match names.len() {
        0 => "a part".to_owned(),
        few if few <= MAX_NAMES => names.join(" and "),
        many => format!(
            "{} and {} more",
            names[..MAX_NAMES - 1].join(", "),
            many + 1 - MAX_NAMES
        ),
    }
}

/// Finding on seams that hang in a heap.
fn crumpled(job: &GarmentJob, run: &GarmentRun) -> Option<Finding> {
    let mut short = short_seams(job, run.target(), &run.state.positions, &taut(run));
    short.sort_by(|a, b| (a.hangs / a.cloth).total_cmp(&(b.hangs / b.cloth)));
    let worst = short.first()?;
    let more = match short.len() {
        1 => String::new(),
        many => format!(" (and {} more)", many - 1),
    };
    let words = format!(
        "it hangs crumpled: seam {:?}{more} is {:.1} cm long and hangs in {:.1} cm; see that no piece is sewn inside out or held up, and that the pieces lie where they hang",
        worst.name,
        worst.cloth * 1e2,
        worst.hangs * 1e2
    );
    Some(Finding::bad(Aspect::Hang, words))
}

/// The merged vertices of cloth that is stretched beyond `TIGHT`.
fn taut(run: &GarmentRun) -> BTreeSet<u32> {
    let stretch = stretch_per_triangle(&run.system, &run.state.positions);
    let triangles = run.system.topology.triangles.iter().zip(stretch);
    let tight = triangles.filter(|(_, stretch)| *stretch > TIGHT);
    tight.flat_map(|(corners, _)| *corners).collect()
}

/// Finding that the cloth is in more connected parts than there are garments.
fn in_parts(parts: usize, garments: usize) -> Option<Finding> {
    (parts > garments).then(|| {
        let words = format!(
            "the garment is in {parts} parts that no seam joins; sew them together or make them apart"
        );
        Finding::told(Aspect::Parts, words)
    })
}

/// Finding that folds of a garment's cloth intersect.
fn garment_tangle(run: &GarmentRun, measures: &Measures) -> Option<Finding> {
    let [found, most, _] = run.cloth_tally().crossings;
    (measures.self_intersections > 0).then(|| {
        let words = format!(
            "it ends tangled: {} pairs of cloth triangles cross each other ({found} edges of cloth went through cloth when its seams were closed, {most} at most): folds of the cloth lie in one another; try --quality final, more ease, or panels placed farther apart",
            measures.self_intersections
        );
        Finding::bad(Aspect::Tangle, words)
    })
}

/// Finding that cloth passed through a solid: deeper than a limit (m), or with edges from one side to the
/// other.
fn through_solid(
    solid: &str,
    (measures, deepest): (&Measures, f64),
    remedy: &str,
) -> Option<Finding> {
    let (depth, through) = (measures.penetration_max, measures.edges_through_body);
    let is_through = depth > deepest || through > 0;
    (is_through && measures.body_intersections > 0).then(|| {
        let reach = match through {
            0 => String::new(),
            1 => ", an edge of it reaches from one side to the other".to_owned(),
            many => format!(", {many} edges of it reach from one side to the other"),
        };
        let words = format!(
            "cloth went through {solid}: it lies up to {:.1} cm inside{reach}, and {} pairs of triangles of both cross; {remedy}",
            depth * 1e2,
            measures.body_intersections,
        );
        Finding::bad(Aspect::Tangle, words)
    })
}

/// Depth in the body up to which the cloth of a garment still counts as pressed in (m).
fn deepest_in_body(measures: &Measures) -> f64 {
    let is_tight = measures.strain_max.iter().any(|&strain| strain > TIGHT);
    if is_tight { PRESSED } else { THROUGH }
}

/// Findings on cloth that is stretched too much, or crosses the body without having passed through it.
fn tightness(measures: &Measures) -> Vec<Finding> {
    let mut found = Vec::new();
    if measures.body_intersections > 0 {
        let words = format!(
            "{} pairs of cloth and body triangles cross: the cloth is too tight there, or the mesh too coarse; try a larger size, more ease or a finer mesh (--quality final)",
            measures.body_intersections
        );
        found.push(Finding::told(Aspect::Tightness, words));
    }
    for (name, strain) in ["warp", "weft"].iter().zip(measures.strain_max) {
        if strain > TIGHT {
            let words = format!(
                "the cloth is stretched by {:.0} % along the {name} at the tightest place: see fit.png, and add ease there",
                strain * 100.0
            );
            found.push(Finding::told(Aspect::Tightness, words));
        }
    }
    found
}

/// Findings on layers of garments that do not lie outside the layers below them.
fn disorder(measures: &Measures, parts: &[GarmentPart]) -> Vec<Finding> {
    let wrong = measures
        .layers
        .iter()
        .filter(|layer| layer.outer_intersections + layer.astray > 0);
    let words = wrong.map(|layer| {
        let of_layer = |part: &&GarmentPart| part.layer == layer.layer;
        let names: Vec<&str> = parts.iter().filter(of_layer).map(|p| &*p.name).collect();
        let words = format!(
            "{} pairs of triangles of {} and of what is worn over it cross, and {} vertices of that lie under it: give it more ease",
            layer.outer_intersections,
            names.join(" and "),
            layer.astray
        );
        Finding::told(Aspect::Layers, words)
    });
    words.collect()
}

/// Findings on elastics whose ends have not met at the end of the run: those that no force can close, and
/// those that may still close.
fn open_elastics(run: &SceneRun) -> Vec<Finding> {
    let open = run.open_attachments();
    let settings = run.settings();
    let moves = |one: &OpenAttachment| {
        let in_time = !settings.method.kind.is_equilibrium();
        in_time && one.closing * settings.duration > CLOSING * one.gap
    };
    let (held, loose): (Vec<_>, Vec<_>) = open.into_iter().partition(|one| one.is_held);
    let (yet, stuck): (Vec<_>, Vec<_>) = loose.into_iter().partition(moves);
    let told = |all: &[OpenAttachment], why: &str, remedy: &str| {
        let worst = all.iter().max_by(|a, b| a.gap.total_cmp(&b.gap))?;
        let count = match all.len() {
            1 => String::new(),
            many => format!(" (and {} more)", many - 1),
        };
        Some(format!(
            "{}{count} {why} {:.1} mm apart; {remedy}",
            elastic_name(run, worst.index),
            worst.gap * 1e3
        ))
    };
    let bad = [
        told(
            &held,
            "can never close: both ends are held,",
            "let one of its ends go, or hold both at one place",
        ),
        told(
            &stuck,
            "is not closed and closes no more: weight, cloth or a solid holds its ends",
            "give it more stiffness, lay its ends nearer, or clear what lies between",
        ),
    ];
    let bad = bad
        .into_iter()
        .flatten()
        .map(|words| Finding::bad(Aspect::Seams, words));
    let words = told(
        &yet,
        "is not closed yet: its ends are",
        "give the scene a longer duration",
    );
    bad.chain(words.map(|words| Finding::told(Aspect::Seams, words)))
        .collect()
}

/// Least share of its gap (1) that an open elastic would close in a further run of the same length, at its
/// present speed, if it counts as closing.
const CLOSING: f64 = 0.5;

/// Words for an elastic: its index in the scene, with its ends.
fn elastic_name(run: &SceneRun, index: usize) -> String {
    let world = run.world();
    let point = |p: Vec3| format!("[{:.3}, {:.3}, {:.3}]", p.x, p.y, p.z);
    let name = |id| world.object(id).map_or("", |object| &object.name);
    let end = |end: AttachmentEnd| match end {
        AttachmentEnd::Vertex(vertex) => {
            format!("vertex {} of \"{}\"", vertex.vertex, name(vertex.object))
        }
        AttachmentEnd::Surface {
            object, triangle, ..
        } => format!("triangle {triangle} of \"{}\"", name(object)),
        AttachmentEnd::TrackFrame { object, frame, .. } => {
            format!("frame {frame} of \"{}\"", name(object))
        }
        AttachmentEnd::Point(p) | AttachmentEnd::Frame { point: p, .. } => point(p),
    };
    let found = world.attachments().nth(index);
    let ends = found.map_or_else(String::new, |(_, attachment)| {
        let [from, to] = attachment.ends.map(end);
        format!(" from {from} to {to}")
    });
    format!("elastics[{index}]{ends}")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cloth in a body: depth (m), edges from one side to the other, stretch.
    fn in_body(depth: f64, through: usize, strain: f64) -> Measures {
        Measures {
            penetration_max: depth,
            edges_through_body: through,
            body_intersections: 165,
            strain_max: [strain, 0.0],
            ..Measures::default()
        }
    }

    #[test]
    fn cloth_that_goes_through_the_body_is_bad_however_it_is_stretched() {
        let judged = |measures: &Measures| {
            through_solid("the body", (measures, deepest_in_body(measures)), "mend it")
        };
        let skewered = judged(&in_body(0.0216, 6, 0.61)).unwrap();
        assert!(skewered.is_bad && skewered.aspect == Aspect::Tangle);
        for told in ["2.2 cm inside", "6 edges", "165 pairs", "mend it"] {
            assert!(skewered.words.contains(told), "{told}: {}", skewered.words);
        }
        // Pressed in as deep by cloth that is too tight, and deeper than that explains.
        assert_eq!(judged(&in_body(0.0205, 0, 0.61)), None);
        assert!(judged(&in_body(0.031, 0, 0.61)).is_some());
        assert!(judged(&in_body(0.0205, 0, 0.1)).is_some());
        // All of it in the hollow of a solid: nothing crosses.
        let inside = Measures {
            body_intersections: 0,
            ..in_body(0.5, 9, 0.0)
        };
        assert_eq!(judged(&inside), None);
    }

    #[test]
    fn cloth_of_a_scene_is_told_from_twice_its_length_on() {
        assert_eq!(overstretched(&in_body(0.0, 0, 0.99)), None);
        let told = overstretched(&in_body(0.0, 0, 17.6)).unwrap();
        assert!(!told.is_bad);
        assert!(told.words.contains("18.6 times its length along the warp"));
    }

    #[test]
    fn a_report_names_what_was_judged() {
        let mut verdict = Verdict::default();
        verdict.judge(Aspect::Rest, None);
        verdict.judge(Aspect::Tangle, [Finding::bad(Aspect::Tangle, "two folds")]);
        let written = serde_json::to_value(&verdict).unwrap();
        let expected = serde_json::json!({
            "sound": false,
            "at_rest": true,
            "tangled": true,
            "findings": [ { "aspect": "tangle", "is_bad": true, "words": "two folds" } ],
        });
        assert_eq!(written, expected);
    }
}
