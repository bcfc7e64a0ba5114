//! Pieces of patterns that FreeSewing drew: by the names of its groups, the classes of its lines, and its signs.

use super::drawing::{Drawing, Element, Line};
use super::join::{append, ends, joined};
use super::piece::SvgPiece;
use super::region::{Region, places};
use crate::Loss;
use crate::drawn::allowance::nearest;
use crate::drawn::piece::{Chords, DrawnLine, Span};
use toile_geometry::Vec2;
use toile_pattern::{Cut, NotchKind};

/// Ends that are nearer meet (mm): coordinates are rounded to 0.01.
const GAP: f64 = 0.03;
/// Farthest that an end of the allowance's line lies from the sew line (mm).
const MAX_REACH: f64 = 100.0;
/// Longest way between the ends of an allowance's line that goes round the sew line, over their distance from it (1).
const MAX_GAP_WIDTHS: f64 = 3.0;
/// Classes of the materials that parts are cut from.
const MATERIALS: [&str; 5] = ["fabric", "lining", "interfacing", "canvas", "various"];
/// Classes of lines that are no outline, though of a material.
const NO_OUTLINE: [&str; 10] = [
    "sa", "help", "dashed", "dotted", "lashed", "hidden", "note", "mark", "contrast", "scalebox",
];
/// Most pieces that a note of cutting may ask for.
const MAX_QUANTITY: u32 = 100;

/// The pieces of a drawing, the name of its design, and what was left out.
pub(super) fn pieces(drawing: &Drawing) -> (Vec<SvgPiece>, String, Vec<Loss>) {
    let mut losses = Vec::new();
    let mut pieces = Vec::new();
    let mut design = String::new();
    for (group, own) in drawing.groups.iter().enumerate() {
        let Some((_, part)) = own.id.split_once("-part-") else {
            continue;
        };
        // A part is named after its design: brian.back.
        let (of, name) = part.rsplit_once('.').unwrap_or(("", part));
        if design.is_empty() || design == "library" {
            of.clone_into(&mut design);
        }
        pieces.extend(piece(drawing, (group, name), &mut losses));
    }
    (pieces, design, losses)
}

/// The piece of a part's group; `None` if the part draws no outline.
fn piece(
    drawing: &Drawing,
    (group, name): (usize, &str),
    losses: &mut Vec<Loss>,
) -> Option<SvgPiece> {
    let own: Vec<(usize, &Line, &Element)> = drawing
        .lines
        .iter()
        .enumerate()
        .map(|(k, line)| (k, line, drawing.element(line)))
        .filter(|(_, _, element)| drawing.is_within(element.group, group))
        .collect();
    if own.is_empty() {
        return None;
    }
    let fold = own
        .iter()
        .find(|(.., element)| element.marker.contains("cutonfold"));
    let fold_ends = fold.map(|(_, line, _)| ends(&line.shape));
    let (sew, used, material) = outline(&own, fold_ends).or_else(|| {
        losses.push(Loss::at(name, "a part", "none of its lines is closed"));
        None
    })?;
    let region = Region::of(&sew);
    let ring = sew.chords(0).points;
    let allowance = allowance(&own, material);
    let cut = match allowance.is_empty() {
        true => None,
        false => {
            let lines = joined(allowance, GAP).into_iter();
            Some(cut_line(
                &sew,
                lines.map(|line| around(line, &ring)).collect(),
            ))
        }
    };
    let (quantity, materials) = quantity(drawing, group);
    let mut piece = SvgPiece {
        name: name.to_owned(),
        quantity,
        fold: fold_ends,
        ..SvgPiece::default()
    };
    let grain = own
        .iter()
        .find(|(.., element)| element.marker.contains("grainline"));
    let on_fold = fold.filter(|(.., element)| element.words.to_lowercase().contains("grain"));
    piece.grain = grain.or(on_fold).map(|(_, line, _)| ends(&line.shape));
    let mut outside = 0;
    let mut scale_boxes = 0;
    for (k, line, element) in &own {
        let is_sign = ["cutonfold", "grainline"]
            .iter()
            .any(|sign| element.marker.contains(sign));
        if used.contains(k) || is_sign || element.has("sa") || element.has("hidden") {
            continue;
        }
        if element.has("scalebox") {
            scale_boxes += 1;
        } else if region.holds(&places(&line.shape), GAP) {
            piece.inside.push(line.shape.clone());
        } else {
            outside += 1;
        }
    }
    let notches = drawing
        .signs
        .iter()
        .filter(|sign| drawing.is_within(sign.group, group));
    let mut others = 0;
    for sign in notches {
        match sign.name.as_str() {
            // The back is told from the front by two notches elsewhere, here by another shape.
            "notch" => piece.notches.push((sign.at, NotchKind::Slit)),
            "bnotch" => piece.notches.push((sign.at, NotchKind::V)),
            _ => others += 1,
        }
    }
    // Signs inside the piece match no edge: they become no notches, and are told.
    let is_on_line = |at: Vec2| nearest(at, &ring).is_some_and(|found| found.distance <= 1.0);
    let all = piece.notches.len();
    piece.notches.retain(|(at, _)| is_on_line(*at));
    let inner = all - piece.notches.len();
    let told = [
        (
            outside,
            "lines outside the sew line",
            "they belong to no piece",
        ),
        (inner, "notches away from the sew line", "they mark no edge"),
        (
            others,
            "buttons, buttonholes and emblems",
            "the document has no place for them",
        ),
        (
            materials,
            "cuts from other materials",
            "a panel is cut from one",
        ),
        (
            scale_boxes,
            "boxes that show the scale",
            "prints have their own",
        ),
    ];
    for (count, what, why) in told.into_iter().filter(|(count, ..)| *count > 0) {
        losses.push(Loss {
            count,
            ..Loss::at(name, what, why)
        });
    }
    piece.sew = Some(sew);
    piece.cut = cut;
    Some(piece)
}

/// The material that a line is drawn for by its classes; `None` if they name none.
fn material_of(element: &Element) -> Option<&'static str> {
    MATERIALS.into_iter().find(|class| element.has(class))
}

/// The lines of the allowance of a part that is cut from a material: those of that material, else those of none,
/// else those of the first material that has any.
fn allowance(own: &[(usize, &Line, &Element)], material: Option<&str>) -> Vec<DrawnLine> {
    let others = MATERIALS.into_iter().map(Some);
    let mut materials = [material, None].into_iter().chain(others);
    let of = |material: Option<&str>| -> Vec<DrawnLine> {
        own.iter()
            .filter(|(.., element)| element.has("sa") && material_of(element) == material)
            .map(|(_, line, _)| line.shape.clone())
            .collect()
    };
    let found = materials.find_map(|material| Some(of(material)).filter(|lines| !lines.is_empty()));
    found.unwrap_or_default()
}

/// The sew line of a part, the lines that it was made of, and the class of its material: the largest closed
/// line of a material; else its open lines joined, and closed along the fold. Lines without the class of a
/// material come last.
fn outline(
    own: &[(usize, &Line, &Element)],
    fold: Option<[Vec2; 2]>,
) -> Option<(DrawnLine, Vec<usize>, Option<&'static str>)> {
    for material in MATERIALS.into_iter().map(Some).chain([None]) {
        let of = |(.., element): &&(usize, &Line, &Element)| {
            let is_other = NO_OUTLINE.iter().any(|class| element.has(class));
            material_of(element) == material && !is_other && element.marker.is_empty()
        };
        let candidates: Vec<_> = own.iter().filter(of).collect();
        let closed = candidates
            .iter()
            .map(|(k, line, _)| (*k, super::join::returned(line.shape.clone(), GAP)))
            .filter(|(_, line)| line.is_closed);
        let largest = closed.max_by(|(_, a), (_, b)| {
            let [a, b] = [a, b].map(|line| line.area(0).abs());
            a.total_cmp(&b)
        });
        if let Some((k, line)) = largest {
            return Some((line, vec![k], material));
        }
        let open = candidates.iter().map(|(_, line, _)| line.shape.clone());
        let mut open = joined(open.collect(), GAP);
        let length = |line: &DrawnLine| {
            let points = line.chords(0).points;
            points
                .windows(2)
                .map(|pair| (pair[1] - pair[0]).norm())
                .sum::<f64>()
        };
        open.sort_by(|a, b| length(a).total_cmp(&length(b)));
        if let Some(mut line) = open.pop() {
            let on_fold = |p: Vec2| {
                fold.is_some_and(|[a, b]| {
                    let along = b - a;
                    (along.perp(&(p - a)) / along.norm()).abs() <= GAP
                })
            };
            if !line.is_closed && line.len() > 2 && ends(&line).into_iter().all(on_fold) {
                line.is_closed = true;
                let count = line.len();
                line.spans.resize(count - 1, Span::Straight);
                line.spans.push(Span::Straight);
            }
            if line.is_closed {
                let used = candidates.iter().map(|(k, ..)| *k).collect();
                return Some((line, used, material));
            }
        }
    }
    None
}

/// A line of the allowance closed, if it goes round the sew line and its ends lie at one corner.
fn around(mut line: DrawnLine, sew: &[Vec2]) -> DrawnLine {
    let [first, last] = ends(&line);
    let reach = |end: Vec2| nearest(end, sew).map_or(0.0, |found| found.distance);
    let gap = (last - first).norm();
    if line.is_closed || line.len() < 3 || gap > MAX_GAP_WIDTHS * reach(first).min(reach(last)) {
        return line;
    }
    line.is_closed = true;
    line.spans.resize(line.len(), Span::Straight);
    match Region::of(&line).holds(sew, GAP) {
        true => line,
        false => {
            line.is_closed = false;
            line.spans.truncate(line.len() - 1);
            line
        }
    }
}

/// The cut line of a part: the sew line, with the lines of its allowance in the place of those stretches that
/// they run along.
fn cut_line(sew: &DrawnLine, allowance: Vec<DrawnLine>) -> DrawnLine {
    if let Some(closed) = allowance
        .iter()
        .filter(|line| line.is_closed)
        .max_by(|a, b| {
            let [a, b] = [a, b].map(|line| line.area(0).abs());
            a.total_cmp(&b)
        })
    {
        return closed.clone();
    }
    let mut sew = sew.clone();
    if sew.area(0) < 0.0 {
        sew.reverse();
    }
    let chords = sew.chords(0);
    let mut stretches: Vec<([f64; 2], DrawnLine)> = allowance
        .into_iter()
        .filter_map(|line| beside(line, &chords))
        .collect();
    stretches.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]));
    // Those that run into one another cannot be told apart.
    let mut after = f64::NEG_INFINITY;
    stretches.retain(|([from, to], _)| {
        let is_free = *from >= after - 1e-6;
        if is_free {
            after = *to;
        }
        is_free
    });
    let Some(([first, _], _)) = stretches.first() else {
        return sew;
    };
    let count = chords.points.len() as f64;
    let starts: Vec<f64> = stretches
        .iter()
        .map(|([from, _], _)| *from)
        .skip(1)
        .collect();
    let next = starts.into_iter().chain([first + count]);
    let mut whole: Option<DrawnLine> = None;
    for (([_, to], line), next) in stretches.clone().into_iter().zip(next) {
        for part in [line, along(&chords, to, next)] {
            match &mut whole {
                None => whole = Some(part),
                Some(whole) => {
                    let way = straight(vec![ends(whole)[1], ends(&part)[0]]);
                    append(whole, way);
                    append(whole, part);
                }
            }
        }
    }
    let mut whole = whole.unwrap_or(sew);
    whole.is_closed = true;
    whole.spans.resize(whole.len(), Span::Straight);
    whole
}

/// The stretch of a sew line beside which a line of its allowance runs, as the places of its ends along the
/// chords, with the line turned to run the same way.
fn beside(mut line: DrawnLine, chords: &Chords) -> Option<([f64; 2], DrawnLine)> {
    let ring = &chords.points;
    let count = ring.len() as f64;
    let place = |p: Vec2| {
        let found = nearest(p, ring).filter(|found| found.distance <= MAX_REACH)?;
        Some(found.chord as f64 + found.share)
    };
    let [a, b] = ends(&line);
    let (a, b) = (place(a)?, place(b)?);
    let later = |from: f64, to: f64| if to > from { to } else { to + count };
    // The line lies nearer to the stretch that it belongs to than to the rest of the outline.
    let points = line.chords(0).points;
    let away = |from: f64, to: f64| {
        let samples = (1..8).map(|k| at(ring, from + (to - from) * f64::from(k) / 8.0));
        let off = samples.map(|p| {
            let to_line = points.windows(2).map(|pair| {
                let place = toile_geometry::closest_on_segment(p, [pair[0], pair[1]]);
                (place - p).norm()
            });
            to_line.fold(f64::INFINITY, f64::min)
        });
        off.fold(0.0, f64::max)
    };
    let [onward, back] = [[a, later(a, b)], [b, later(b, a)]];
    let is_onward = away(onward[0], onward[1]) <= away(back[0], back[1]);
    let found = match is_onward {
        true => onward,
        false => {
            line.reverse();
            back
        }
    };
    Some((found, line))
}

/// The place on a closed line that is an index of a chord and a share of it.
fn at(ring: &[Vec2], place: f64) -> Vec2 {
    let k = place.floor();
    let [a, b] = [k as usize, k as usize + 1].map(|k| ring[k % ring.len()]);
    a + (b - a) * (place - k)
}

/// A stretch of a closed line from one place to a later one, as chords.
fn along(chords: &Chords, from: f64, to: f64) -> DrawnLine {
    let ring = &chords.points;
    let inner = (from.floor() as usize + 1)..=(to.ceil() as usize).saturating_sub(1);
    let inner = inner.map(|k| ring[k % ring.len()]);
    let points = std::iter::once(at(ring, from)).chain(inner);
    straight(points.chain([at(ring, to)]).collect())
}

fn straight(points: Vec<Vec2>) -> DrawnLine {
    DrawnLine {
        spans: vec![Span::Straight; points.len() - 1],
        ..DrawnLine::one(points, false)
    }
}

/// The number of pieces that the words in a part ask for, as FreeSewing writes them before they are translated or
/// in English, and the number of further cuts of other materials.
fn quantity(drawing: &Drawing, group: usize) -> (Cut, usize) {
    let texts = drawing
        .texts
        .iter()
        .filter(|text| drawing.is_within(text.group, group));
    let mut found = (0, false);
    let mut others = 0;
    for text in texts {
        let words = text.words.to_lowercase().replace("plugin-annotations:", "");
        let is_note = words.starts_with("cut,") || words.starts_with("cut ");
        let cuts = words.split("cut").skip(1).filter(|_| is_note);
        for cut in cuts {
            let digits = cut.trim_start_matches([',', ' ']);
            let digits: String = digits.chars().take_while(char::is_ascii_digit).collect();
            let Ok(number) = digits.parse::<u32>() else {
                continue;
            };
            match MATERIALS[1..].iter().any(|material| cut.contains(material)) {
                true => others += 1,
                false => found = (found.0 + number.min(MAX_QUANTITY), cut.contains("mirror")),
            }
        }
    }
    let cut = match found {
        (0, _) => Cut::default(),
        (quantity, mirrored) => Cut {
            quantity: quantity.min(MAX_QUANTITY),
            mirrored: mirrored && quantity > 1,
        },
    };
    (cut, others)
}
