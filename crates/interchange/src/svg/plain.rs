//! Pieces of drawings of any program: layers and groups with a closed line, else outermost closed lines.

use super::drawing::Drawing;
use super::join::{ends, joined};
use super::piece::SvgPiece;
use super::region::{Region, places};
use crate::drawn::piece::DrawnLine;
use crate::{FormatError, Loss};
use std::collections::BTreeMap;
use toile_geometry::Vec2;

/// Largest distance of a sew line from the cut line round it (m).
const MAX_ALLOWANCE: f64 = 0.05;
/// Largest gap between the ends of open lines that meet (m).
const GAP: f64 = 2e-5;
/// Least share of the cut line's area that a sew line encloses.
const MIN_SEWN: f64 = 0.3;
/// Share of the page that a rectangle fills that is its background or frame.
const PAGE: f64 = 0.995;
/// Most pieces of a drawing.
const MAX_PIECES: usize = 2_000;
/// Least extent of a piece (m): smaller closed lines alone are no piece.
const MIN_EXTENT: f64 = 0.005;

/// A line of the drawing with the group and element that it stands in.
struct Own {
    shape: DrawnLine,
    places: Vec<Vec2>,
    group: usize,
    element: usize,
}

impl Own {
    fn new(shape: DrawnLine, group: usize, element: usize) -> Self {
        Self {
            places: places(&shape),
            shape,
            group,
            element,
        }
    }
}

/// The pieces of a drawing whose unit is about so long (m), and what was left out.
///
/// # Errors
/// More closed lines side by side than a pattern has pieces.
pub(super) fn pieces(
    drawing: &Drawing,
    (unit, page): (f64, Option<[f64; 4]>),
    losses: &mut Vec<Loss>,
) -> Result<Vec<SvgPiece>, FormatError> {
    let lines = own_lines(drawing, GAP / unit);
    let regions: Vec<Option<Region>> = lines
        .iter()
        .map(|line| line.shape.is_closed.then(|| Region::of(&line.shape)))
        .collect();
    // A frame round the page lies round all pieces.
    let is_frame = |k: usize| {
        let (Some(region), Some([.., w, h])) = (&regions[k], page) else {
            return false;
        };
        let size = region.bounds().size();
        lines[k].shape.len() == 4
            && size.x >= PAGE * w
            && size.y >= PAGE * h
            && regions.iter().flatten().count() > 1
    };
    let frames: Vec<usize> = (0..lines.len()).filter(|&k| is_frame(k)).collect();
    if !frames.is_empty() {
        losses.push(Loss {
            count: frames.len(),
            ..Loss::at(
                "",
                "frames round the page",
                "they are no outlines of pieces",
            )
        });
    }
    let mut closed: Vec<usize> = (0..lines.len())
        .filter(|k| !frames.contains(k))
        .filter(|&k| regions[k].as_ref().is_some_and(|region| region.area > 0.0))
        .collect();
    let area = |k: usize| regions[k].as_ref().map_or(0.0, |region| region.area);
    closed.sort_by(|&a, &b| area(b).total_cmp(&area(a)));
    let layer = |k: usize| layer_of(drawing, lines[k].group);
    // Outermost lines, each with its layer.
    let mut outer: Vec<(usize, &Region)> = Vec::new();
    for &k in &closed {
        let Some(region) = &regions[k] else { continue };
        let lies_in = |&(other, around): &(usize, &Region)| match layer(other) == layer(k) {
            true => around.holds(&lines[k].places, 0.0),
            false => around.holds_evenly(&lines[k].places, MAX_ALLOWANCE / unit),
        };
        if region.extent() * unit >= MIN_EXTENT && !outer.iter().any(lies_in) {
            outer.push((k, region));
        }
        if outer.len() > MAX_PIECES {
            return Err(FormatError::new(
                "the whole file",
                format!("more than {MAX_PIECES} closed lines lie side by side in it"),
                "keep the outlines of pieces, and leave out pictures and patterns of cloth",
            ));
        }
    }
    // The order of the file.
    outer.sort_by_key(|(k, _)| *k);
    let groups = exclusive_groups(
        drawing,
        &outer
            .iter()
            .map(|&(k, _)| lines[k].group)
            .collect::<Vec<_>>(),
    );
    let mut owners: BTreeMap<usize, usize> = BTreeMap::new();
    for (k, line) in lines.iter().enumerate() {
        if frames.contains(&k) {
            continue;
        }
        let own = outer.iter().position(|&(other, _)| other == k);
        let by_group = || {
            groups
                .iter()
                .position(|group| group.is_some_and(|group| drawing.is_within(line.group, group)))
        };
        let gap = GAP / unit;
        let by_place = || {
            let same = |&(other, _): &(usize, &Region)| layer(other) == layer(k);
            let holds = |(_, region): &(usize, &Region)| region.holds(&line.places, gap);
            let first = outer.iter().position(|one| same(one) && holds(one));
            first.or_else(|| outer.iter().position(holds))
        };
        if let Some(owner) = own.or_else(by_group).or_else(by_place) {
            owners.insert(k, owner);
        }
    }
    let lost = lines.len() - frames.len() - owners.len();
    if lost > 0 {
        losses.push(Loss {
            count: lost,
            ..Loss::at("", "lines outside all pieces", "they belong to none")
        });
    }
    let mut pieces = Vec::new();
    for (number, &(k, region)) in outer.iter().enumerate() {
        let mut inner = Vec::new();
        for (&other, _) in owners
            .iter()
            .filter(|(other, owner)| **owner == number && **other != k)
        {
            inner.push(other);
        }
        let sew = inner
            .iter()
            .copied()
            .filter(|&other| {
                area(other) > MIN_SEWN * region.area
                    && region.holds_evenly(&lines[other].places, MAX_ALLOWANCE / unit)
            })
            .max_by(|&a, &b| area(a).total_cmp(&area(b)));
        let mut piece = SvgPiece {
            name: name(drawing, (&lines[k], groups[number]), region, number),
            sew: sew.map(|sew| lines[sew].shape.clone()),
            cut: Some(lines[k].shape.clone()),
            ..SvgPiece::default()
        };
        let mut outside = 0;
        for &other in inner.iter().filter(|other| Some(**other) != sew) {
            let line = &lines[other];
            let told = told_as(drawing, line);
            let both = ends(&line.shape);
            if told == Some("grain") && !line.shape.is_closed {
                piece.grain.get_or_insert(both);
            } else if told == Some("fold") && !line.shape.is_closed {
                piece.fold.get_or_insert(both);
            } else if region.holds(&line.places, GAP / unit) {
                piece.inside.push(line.shape.clone());
            } else {
                outside += 1;
            }
        }
        if outside > 0 {
            losses.push(Loss {
                count: outside,
                ..Loss::at(
                    &piece.name,
                    "lines beyond the outline",
                    "they mark nothing on it",
                )
            });
        }
        pieces.push(piece);
    }
    Ok(pieces)
}

/// All lines, the open ones of a group without a closed line joined.
fn own_lines(drawing: &Drawing, gap: f64) -> Vec<Own> {
    let mut by_group: BTreeMap<usize, Vec<Own>> = BTreeMap::new();
    for line in &drawing.lines {
        let group = drawing.element(line).group;
        let shape = super::join::returned(line.shape.clone(), gap);
        let own = Own::new(shape, group, line.element);
        by_group.entry(group).or_default().push(own);
    }
    let mut all = Vec::new();
    for (group, lines) in by_group {
        if lines.iter().any(|line| line.shape.is_closed) {
            all.extend(lines);
            continue;
        }
        let element = lines.first().map_or(0, |line| line.element);
        let count = lines.len();
        let shapes: Vec<DrawnLine> = lines.iter().map(|line| line.shape.clone()).collect();
        let joined = joined(shapes, gap);
        match joined.iter().any(|line| line.is_closed) && joined.len() < count {
            true => {
                let own = joined.into_iter();
                all.extend(own.map(|shape| Own::new(shape, group, element)));
            }
            false => all.extend(lines),
        }
    }
    // The order of the file.
    all.sort_by_key(|line| line.element);
    all
}

/// The outermost layer that a group stands in.
fn layer_of(drawing: &Drawing, group: usize) -> Option<usize> {
    let layers = drawing
        .chain(group)
        .filter(|&group| drawing.groups[group].is_layer);
    layers.last()
}

/// For each of some groups, the outermost group round it that is round none of the others; `None` where there is
/// none.
fn exclusive_groups(drawing: &Drawing, groups: &[usize]) -> Vec<Option<usize>> {
    let mut count = vec![0; drawing.groups.len()];
    for &group in groups {
        drawing.chain(group).for_each(|group| count[group] += 1);
    }
    let of = |&group: &usize| {
        let own = drawing
            .chain(group)
            .filter(|&group| group != 0 && count[group] == 1);
        own.last()
    };
    groups.iter().map(of).collect()
}

/// The name of a piece: the label of its group or line, an identifier that somebody gave, words that stand in it,
/// else its number.
fn name(
    drawing: &Drawing,
    (line, group): (&Own, Option<usize>),
    region: &Region,
    number: usize,
) -> String {
    let inner: Vec<usize> = match group {
        Some(group) => drawing
            .chain(line.group)
            .take_while(|&own| own != group)
            .chain([group])
            .collect(),
        None => Vec::new(),
    };
    let element = &drawing.elements[line.element];
    let labels = inner
        .iter()
        .rev()
        .filter_map(|&group| drawing.groups[group].label.clone());
    let ids = inner
        .iter()
        .rev()
        .map(|&group| drawing.groups[group].id.clone());
    let ids = ids.chain([element.id.clone()]).filter(|id| is_given(id));
    let text = drawing.texts.iter().find(|text| {
        let own = group.is_some_and(|group| drawing.is_within(text.group, group));
        own || region.contains(text.at)
    });
    let mut names = labels
        .chain(element.label.clone())
        .chain(ids)
        .chain(text.map(|text| text.words.clone()));
    names
        .next()
        .unwrap_or_else(|| format!("piece {}", number + 1))
}

/// Whether an identifier is a name that somebody gave, not one that a program counts: path12, g3-7, layer1.
fn is_given(id: &str) -> bool {
    let letters = id.trim_end_matches(|c: char| c.is_ascii_digit() || matches!(c, '-' | '_' | '.'));
    let counted = [
        "", "path", "g", "layer", "svg", "rect", "circle", "ellipse", "polygon", "polyline",
        "line", "use", "group", "a", "text", "fs", "Layer", "Ebene", "SVGID",
    ];
    !counted.contains(&letters)
}

/// Tells a line of the grain and one on the fold by its names.
fn told_as(drawing: &Drawing, line: &Own) -> Option<&'static str> {
    let element = &drawing.elements[line.element];
    let group = &drawing.groups[line.group];
    let mut words = vec![element.id.as_str(), group.id.as_str()];
    words.extend(element.label.as_deref());
    words.extend(group.label.as_deref());
    words.extend(element.classes.iter().map(String::as_str));
    let says = |what: &str| words.iter().any(|word| word.to_lowercase().contains(what));
    ["grain", "fold"].into_iter().find(|what| says(what))
}
