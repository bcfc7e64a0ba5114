//! Points that cut curves, and the parts of these.

use super::build::{Build, Slot, reference};
use super::kinds::LENGTH;
use super::things::Made;
use super::things::{CurveThing, PointThing, Thing};
use crate::exchange::Loss;
use roxmltree::Node;
use std::sync::Arc;
use toile_pattern::PointRule;

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
    if curve.sheet != build.current() {
        return Err("its curve belongs to another drawing".to_owned());
    }
    let total = curve.path.length();
    const NAME: &str = "CurrentLength";
    build.name_length(NAME.to_owned(), &curve.length, total);
    let distance = build.number(node, "length", LENGTH);
    build.symbols.remove(NAME);
    let distance = distance?;
    // A negative length counts from the end; none is longer than the curve.
    let along = match distance.value < 0.0 {
        true => total + distance.value,
        false => distance.value,
    };
    if !(0.0..=total).contains(&along) {
        return Err("its length is more than that of the curve".to_owned());
    }
    let place = curve
        .path
        .at_length(along)
        .ok_or("its curve has no length")?;
    let at = curve.path.point(place);
    let text = match distance.value < 0.0 {
        true => format!("({} + {})", curve.length, distance.text),
        false => distance.text.clone(),
    };
    let number = match curve.is_whole {
        true => distance.number.clone(),
        false => along_whole(build, &curve, &text)?,
    };
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
            [1, 2].map(|step| format!("Arc_{centre}_{}", id.saturating_add(step)))
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
        let number = id.saturating_add(k as u32 + 1);
        let part = CurveThing {
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
        let known = build.things.entry(number);
        known.or_insert(Thing::Curve(Arc::new(part)));
    }
    Ok(())
}
