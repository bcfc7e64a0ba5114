//! Points that cut curves, and the parts of these.

use super::build::{Build, Slot, reference};
use super::kinds::LENGTH;
use super::things::Made;
use super::things::{CurveThing, PointThing, Thing};
use crate::exchange::Loss;
use roxmltree::Node;
use std::sync::Arc;
use toile_pattern::PointRule;

/// Length of the shortest part of a curve that is cut off (m).
const MIN_PART: f64 = 1e-3;

/// Makes the point of a tool that cuts a curve. `None`: the tool is none of these.
pub(super) fn point(build: &mut Build, node: Node<'_, '_>, tool: &str) -> Option<Made> {
    let attribute = match tool {
        "cutSpline" => "spline",
        "cutSplinePath" => "splinePath",
        "cutArc" => "arc",
        _ => return None,
    };
    Some(cut(build, node, attribute))
}

fn cut(build: &mut Build, node: Node<'_, '_>, attribute: &str) -> Made {
    let curve = build.curve(node, attribute)?;
    let total = curve.path.length();
    const NAME: &str = "CurrentLength";
    build.name_length(NAME.to_owned(), &curve.length, total);
    let distance = build.number(node, "length", LENGTH);
    build.symbols.remove(NAME);
    let mut distance = distance?;
    let own = build.symbols.get(&curve.name);
    if own.is_some_and(|length| length.value < 0.0) {
        // The length of a clockwise arc is negative there, and so are those along it.
        let text = format!("(-{})", distance.text);
        distance = Slot {
            number: build.formula(&text)?,
            value: -distance.value,
            text,
        };
    }
    let counts_back = distance.value < 0.0 && (attribute == "arc" || build.from_ends);
    let along = match counts_back {
        true => total + distance.value,
        false => distance.value,
    };
    let least = MIN_PART.min(total / 2.0);
    let is_within = (least - 1e-9..=total - least + 1e-9).contains(&along);
    let along = along.clamp(least, total - least);
    let place = curve
        .path
        .at_length(along)
        .ok_or("its curve has no length")?;
    let at = curve.path.point(place);
    let text = match (is_within, counts_back) {
        (true, true) => format!("({} + {})", curve.length, distance.text),
        (true, false) => distance.text.clone(),
        (false, _) if along < total / 2.0 => format!("{along}m"),
        (false, _) => format!("({} - {least}m)", curve.length),
    };
    let number = match curve.is_whole && is_within {
        true => distance.number.clone(),
        false => along_whole(build, &curve, &text)?,
    };
    if !is_within {
        let name = node.attribute("name").unwrap_or_default();
        let why = "its length does not lie on the curve in the base size: 1 mm from the end is taken, as there";
        build.losses.push(Loss::at(name, "the place of a cut", why));
    }
    let rule = PointRule::AlongCurve {
        curve: curve.id,
        distance: number,
    };
    let name = node.attribute("name").unwrap_or_default();
    let made = build.add_point(name, rule, at);
    let first = Slot {
        number: distance.number,
        text,
        value: along,
    };
    parts(build, node, &curve, made, Some(first))?;
    Ok(made)
}

/// A length from the start of a part of a curve as a length from the start of the whole.
fn along_whole(
    build: &Build,
    curve: &CurveThing,
    text: &str,
) -> Result<toile_pattern::Number, String> {
    match &curve.start {
        None => build.formula(text),
        Some(start) => build.formula(&format!("{start} + {text}")),
    }
}

/// Names both parts of a curve that a point cuts, as in `Spl_A_X` and `Spl_X_B`, and makes them known under
/// the numbers after that of the point.
pub(super) fn parts(
    build: &mut Build,
    node: Node<'_, '_>,
    curve: &Arc<CurveThing>,
    point: PointThing,
    first: Option<Slot>,
) -> Result<(), String> {
    let id = reference(node, "id")?;
    let name = node.attribute("name").unwrap_or_default();
    let numbers = [("segment1Id", 1), ("segment2Id", 2)].map(|(attribute, step)| {
        reference(node, attribute).unwrap_or_else(|_| id.saturating_add(step))
    });
    let total = curve.path.length();
    let along = match &first {
        Some(first) => first.value,
        None => {
            let nearest = curve.path.nearest(point.at);
            nearest.map_or(0.0, |place| place.along)
        }
    };
    let unit = build.unit;
    let fixed = |metres: f64| format!("{}{}", unit.of_si(metres, LENGTH), unit.word);
    let lengths = match &first {
        Some(first) => [
            first.text.clone(),
            format!("({} - {})", curve.length, first.text),
        ],
        None => [fixed(along), fixed(total - along)],
    };
    let kind = curve.name.split('_').next().unwrap_or("Spl").to_owned();
    let [a, b] = curve.ends.map(|end| build.file_name(end));
    let names = match kind.as_str() {
        "Arc" => {
            let centre = curve.name.trim_start_matches("Arc_");
            let centre = centre.rsplit_once('_').map_or(centre, |(centre, _)| centre);
            numbers.map(|number| format!("Arc_{centre}_{number}"))
        }
        _ => [format!("{kind}_{a}_{name}"), format!("{kind}_{name}_{b}")],
    };
    let ends = [[curve.ends[0], point], [point, curve.ends[1]]];
    let reach = [[0.0, along], [along, total]];
    let starts = [
        curve.start.clone(),
        Some(match &curve.start {
            None => lengths[0].clone(),
            Some(start) => format!("({start} + {})", lengths[0]),
        }),
    ];
    for (k, start) in starts.into_iter().enumerate() {
        let part = || CurveThing {
            ends: ends[k],
            path: curve.path.between(reach[k][0], reach[k][1]),
            name: names[k].clone(),
            length: lengths[k].clone(),
            start,
            is_whole: false,
            ..(**curve).clone()
        };
        let length = reach[k][1] - reach[k][0];
        let is_new = !build.symbols.contains_key(&names[k]);
        if is_new {
            build.name_length(names[k].clone(), &lengths[k], length);
            if first.is_none() && build.used.contains(&names[k]) {
                build.losses.push(Loss::at(
                    names[k].clone(),
                    "a length between crossings",
                    "its value in the base size is taken",
                ));
            }
        }
        if let Some(alias) = node.attribute(["alias1", "alias2"][k]) {
            build.name_also(&names[k], alias);
        }
        let has_own_number = node.has_attribute(["segment1Id", "segment2Id"][k]);
        let thing = match has_own_number {
            true => Arc::new(part()),
            false => {
                // Files that know parts by these numbers mean the whole curve by them since version 0.2.5.
                build.parts.insert(numbers[k]);
                curve.clone()
            }
        };
        build
            .things
            .entry(numbers[k])
            .or_insert(Thing::Curve(thing));
    }
    Ok(())
}
