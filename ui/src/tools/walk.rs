//! Walks a seam: the pieces of one side are laid on those of the other, and moved along the seam line by
//! pointer, keys or a typed distance. Changes no document.

use super::number;
use super::{Event, LineStep, Outcome, Overlay, Pointer, Reading, Tone};
use crate::canvas::fill::Fill;
use crate::canvas::scene::Scene;
use crate::canvas::selection::{Item, Selection};
use crate::canvas::walked::WalkedSeam;
use std::sync::Arc;
use toile_geometry::{Bounds2, Vec2, closest_on_segment};
use toile_pattern::plan::Affine;
use toile_pattern::walk::{Contact, FixedSide, Joint, Smoothness, Walk, WalkedNotch};
use toile_pattern::{
    DisplayUnit, Draft, DraftSeam, EdgeId, Evaluation, PanelId, Pattern, Piece, SEAM_TOLERANCE,
    SeamId, Want,
};

/// Distance of a step by an arrow key (m).
const STEP: f64 = 0.01;
/// Distance of the pointer from the seam line within which it moves the walk (pixels).
const REACH: f64 = 60.0;
/// Length of the tangents drawn where edges cross the seam (m).
const LEAVING: f64 = 0.03;
/// Length of a notch (m).
const NOTCH: f64 = 0.006;
/// Distance of the point of contact from an end of the seam within which it counts as at that end (m).
const AT_END: f64 = 1e-3;

/// State of a walk.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WalkState {
    /// Arc length along the first side of the seam at which the pieces touch (m).
    along: f64,
    fixed: FixedSide,
    typed: String,
}

impl WalkState {
    /// Whether a distance is being typed.
    pub fn is_typing(&self) -> bool {
        !self.typed.is_empty()
    }
}

/// The walked seam, as displayed on the table.
struct Seen<'r> {
    pattern: &'r Pattern,
    draft: &'r Draft,
    seam: &'r DraftSeam,
    walk: Walk<'r>,
    /// Cached geometry to draw.
    kept: Arc<WalkedSeam>,
    /// Ease: intended difference in length between the sides of the seam (m).
    ease: f64,
    reading: &'r Reading<'r>,
}

/// The first selected seam.
pub fn selected(reading: &Reading<'_>) -> Option<SeamId> {
    let mut items = reading.selection.items().iter();
    items.find_map(|item| match item {
        Item::Seam(id) => Some(*id),
        _ => None,
    })
}

impl<'r> Seen<'r> {
    fn new(reading: &'r Reading<'r>) -> Option<Self> {
        let id = selected(reading)?;
        let pattern = reading.evaluation.pattern();
        let draft: &Draft = &reading.scene.draft;
        let kept = reading.scene.walked(id)?;
        let (seam, walk) = kept.walk(draft)?;
        Some(Self {
            pattern,
            draft,
            seam,
            walk,
            kept,
            ease: reading.evaluation.ease(seam.id),
            reading,
        })
    }

    /// Map from the plane of a piece to the table. The second piece of a mirrored pair is reflected, so
    /// that it appears like the drawn panel.
    fn on_table(&self, piece: &Piece) -> Affine {
        let moved = Affine::translation(self.reading.table_layout.panel(piece.id.panel));
        let panel = self.pattern.panel(piece.id.panel);
        let is_mirrored = panel.is_some_and(|p| p.cut.mirrored) && piece.id.copy % 2 == 1;
        match is_mirrored {
            true => moved.after(&Affine::reflection([Vec2::zeros(), Vec2::y()])),
            false => moved,
        }
    }

    fn piece(&self, contact: &Contact, side: usize) -> Option<&'r Piece> {
        self.draft.pieces.get(contact.pieces[side])
    }

    /// Two maps to the table: from the plane of the piece that stays, and from the plane of the piece that
    /// is laid against it.
    fn maps(&self, contact: &Contact, fixed: FixedSide) -> Option<[Affine; 2]> {
        let base = self.on_table(self.piece(contact, fixed.sides()[0])?);
        Some([base, base.after(&contact.laid)])
    }

    /// Arc length along the first side at the point of the seam nearest to the pointer, and the distance of
    /// the pointer from that point (m).
    fn led(&self, at: &Pointer, fixed: FixedSide) -> Option<(f64, f64)> {
        let side = fixed.sides()[0];
        let mut best: Option<(f64, f64)> = None;
        let mut done: Vec<usize> = Vec::new();
        for (k, _) in self.walk.lines(side) {
            if done.contains(&k) {
                continue;
            }
            done.push(k);
            let piece = self.draft.pieces.get(k)?;
            let map = self.on_table(piece);
            let own = map.source(at.table);
            let along = self.walk.nearest(side, k, own)?;
            let contact = self.walk.contact(along, fixed);
            let away = (map.apply(contact.places[side]) - at.table).norm();
            if best.is_none_or(|(_, least)| away < least) {
                best = Some((along, away));
            }
        }
        best
    }
}

/// Bounding box on the table that a walk of the selected seam needs (m): the piece that stays, and the
/// other piece at both ends of the seam.
pub fn room(state: &WalkState, reading: &Reading<'_>) -> Option<Bounds2> {
    let seen = Seen::new(reading)?;
    let sides = state.fixed.sides();
    let mut places: Vec<Vec2> = Vec::new();
    for along in [0.0, seen.walk.lengths()[0]] {
        let contact = seen.walk.contact(along, state.fixed);
        let maps = seen.maps(&contact, state.fixed)?;
        for (side, map) in sides.into_iter().zip(maps) {
            let piece = seen.kept.pieces.get(&contact.pieces[side])?;
            let outline = piece.rings.iter().take(1).flatten();
            places.extend(outline.map(|at| map.apply(*at)));
        }
    }
    Some(Bounds2::of(places))
}

/// Arc length along the first side of the seam at which the pieces are to touch (m): the typed one, or
/// without typed text the one that was walked to.
///
/// # Errors
/// The typed text gives no length.
fn along(state: &WalkState, reading: &Reading<'_>) -> Result<f64, String> {
    if !state.is_typing() {
        return Ok(state.along);
    }
    let read = number::parse(&state.typed, Want::Length, reading.evaluation)?;
    let value = reading.evaluation.number(&read, Want::Length);
    value.ok_or_else(|| "the formula has no value: mend it, or type a number".to_owned())
}

pub(super) fn step(
    state: &WalkState,
    event: &Event,
    reading: &Reading<'_>,
) -> (WalkState, Outcome) {
    let mut next = state.clone();
    let mut outcome = Outcome::default();
    let Some(seen) = Seen::new(reading) else {
        match event {
            Event::Click(pointer) | Event::DoubleClick(pointer) => {
                match seams_at(pointer, reading).first().copied() {
                    Some(seam) => outcome.select = Some(Selection::one(Item::Seam(seam))),
                    None => outcome.refusal = Some("no seam is here: click a sewn edge".into()),
                }
            }
            Event::Escape => outcome.done = true,
            _ => {}
        }
        return (WalkState::default(), outcome);
    };
    if let Event::Click(pointer) | Event::DoubleClick(pointer) = event {
        let there = seams_at(pointer, reading);
        let is_walked = selected(reading).is_some_and(|id| there.contains(&id));
        if let (Some(other), false) = (there.first(), is_walked) {
            outcome.select = Some(Selection::one(Item::Seam(*other)));
            return (WalkState::default(), outcome);
        }
    }
    let whole = seen.walk.lengths()[0];
    match event {
        Event::Hover(pointer) if !state.is_typing() => {
            let near = seen.led(pointer, state.fixed);
            if let Some((along, _)) = near.filter(|(_, away)| *away <= REACH * pointer.pixel) {
                next.along = along;
            }
        }
        Event::Click(pointer) | Event::DoubleClick(pointer) | Event::Drag(_, pointer) => {
            next.typed.clear();
            if let Some((along, _)) = seen.led(pointer, state.fixed) {
                next.along = along;
            }
        }
        Event::Text(text) => next.typed.push_str(text),
        Event::Backspace => {
            next.typed.pop();
        }
        Event::Enter if state.is_typing() => match along(state, reading) {
            Ok(typed) if (0.0..=whole + 1e-9).contains(&typed) => {
                next.along = typed;
                next.typed.clear();
            }
            Ok(_) => {
                let unit = seen.pattern.unit;
                let whole = number::show(whole, Want::Length, unit);
                outcome.refusal = Some(format!(
                    "distance: the seam is {whole} long: type a distance from 0 to that"
                ));
            }
            Err(words) => outcome.refusal = Some(format!("distance: {words}")),
        },
        Event::Escape if state.is_typing() => next.typed.clear(),
        Event::Escape => outcome.done = true,
        Event::Tab => next.fixed = state.fixed.other(),
        Event::Go(way) => {
            next.typed.clear();
            next.along = match way {
                LineStep::Back => state.along.min(whole) - STEP,
                LineStep::On => state.along + STEP,
                LineStep::ToStart => 0.0,
                LineStep::ToEnd => whole,
            };
        }
        Event::Hover(_) | Event::Enter | Event::Leave | Event::Drop => {}
    }
    next.along = next.along.clamp(0.0, whole);
    outcome.gets_on = outcome.refusal.is_none() && next != *state;
    outcome.gets_on &= !matches!(event, Event::Hover(_) | Event::Text(_) | Event::Backspace);
    (next, outcome)
}

/// Seams of the edges under the pointer, the nearest edge first; for each edge one seam.
fn seams_at(pointer: &Pointer, reading: &Reading<'_>) -> Vec<SeamId> {
    let edges = pointer.hits.iter().filter_map(|hit| match hit.item {
        Item::Edge(panel, edge) => seam_of((panel, edge), hit.at, reading),
        _ => None,
    });
    edges.collect()
}

/// The seam of an edge that is nearest to a point of the panel (m).
fn seam_of((panel, edge): (PanelId, EdgeId), at: Vec2, reading: &Reading<'_>) -> Option<SeamId> {
    let seams = reading.scene.seams.iter();
    let stretches = seams.flat_map(|seam| seam.stretches.iter().map(move |own| (seam.id, own)));
    let own = stretches.filter(|(_, own)| (own.panel, own.edge) == (panel, Some(edge)));
    let away = |line: &[Vec2]| {
        let sides = line.windows(2);
        let places = sides.map(|side| closest_on_segment(at, [side[0], side[1]]));
        let least = places.map(|place| (place - at).norm());
        least.fold(f64::INFINITY, f64::min)
    };
    let found = own.map(|(id, own)| (id, away(&own.line)));
    found.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(id, _)| id)
}

pub(super) fn overlay(state: &WalkState, reading: &Reading<'_>) -> Vec<Overlay> {
    let Some(seen) = Seen::new(reading) else {
        return Vec::new();
    };
    let told = along(state, reading);
    let contact = seen
        .walk
        .contact(told.clone().unwrap_or(state.along), state.fixed);
    let Some(maps) = seen.maps(&contact, state.fixed) else {
        return Vec::new();
    };
    let mut marks = Vec::new();
    ghost(&seen, (&contact, state.fixed), &maps, &mut marks);
    let joints = seen.walk.joints(seen.ease);
    for joint in joints.iter().flatten() {
        mark_joint(&seen, joint, (&contact, state.fixed), &maps, &mut marks);
    }
    mark_notches(&seen, (&contact, state.fixed), &maps, &mut marks);
    let [base, _] = state.fixed.sides();
    let at = maps[0].apply(contact.places[base]);
    marks.push(Overlay::Touch(at));
    let mut words = contact_words(&seen, &contact);
    if state.is_typing() {
        let fault = told.err().unwrap_or_default();
        words = format!("distance {}|  {fault}", state.typed);
    }
    marks.push(Overlay::Label(at, words.trim().to_owned(), Tone::Plain));
    marks
}

/// Text at the point of contact: distance along each side of the seam, and their difference.
fn contact_words(seen: &Seen<'_>, contact: &Contact) -> String {
    let unit = seen.pattern.unit;
    let length = |length: f64| number::show(length, Want::Length, unit);
    let [first, second] = contact.along;
    let name = |side: usize| seen.piece(contact, side).map_or("", |piece| &piece.name);
    let apart = first - second;
    let difference = match apart.abs() {
        d if d < 5e-5 => "no difference".to_owned(),
        d => {
            let farther = if apart > 0.0 { name(0) } else { name(1) };
            format!(
                "{farther} {} more",
                number::show(d, Want::Length, DisplayUnit::Millimetre)
            )
        }
    };
    format!(
        "{} {}, {} {}: {difference}",
        name(0),
        length(first),
        name(1),
        length(second)
    )
}

/// Adds the marks for the piece that is laid against the one that stays: its ghost and notches, and the seam
/// line on both pieces.
fn ghost(
    seen: &Seen<'_>,
    (contact, fixed): (&Contact, FixedSide),
    [stays_at, laid]: &[Affine; 2],
    marks: &mut Vec<Overlay>,
) {
    let [base, moved] = fixed.sides();
    let Some(piece) = seen.piece(contact, moved) else {
        return;
    };
    if let Some(flat) = seen.kept.pieces.get(&contact.pieces[moved]) {
        let lay = |ring: &Vec<Vec2>| ring.iter().map(|at| laid.apply(*at)).collect();
        let fill = Fill {
            points: flat
                .fill
                .points
                .iter()
                .map(|at| mapped(laid, *at))
                .collect(),
            indices: flat.fill.indices.clone(),
        };
        marks.push(Overlay::Ghost(flat.rings.iter().map(lay).collect(), fill));
    }
    for notch in &piece.notches {
        let line = [notch.point, notch.point + notch.inward * NOTCH];
        let line = line.map(|at| laid.apply(at)).to_vec();
        marks.push(Overlay::Stroke(line, Tone::Plain));
    }
    for (side, map) in [(moved, laid), (base, stays_at)] {
        let lines = seen.kept.lines[side].iter();
        for (_, line) in lines.filter(|(k, _)| *k == contact.pieces[side]) {
            let line = line.iter().map(|at| map.apply(*at)).collect();
            marks.push(Overlay::Stroke(line, Tone::Plain));
        }
    }
}

/// Moves a corner of the triangles that fill a piece to where the piece is laid.
fn mapped(laid: &Affine, at: [f32; 2]) -> [f32; 2] {
    let at = laid.apply(Vec2::from(at.map(f64::from)));
    [at.x as f32, at.y as f32]
}

/// Tone for the smoothness with which a line crosses a seam.
fn joint_tone(joint: &Joint) -> Tone {
    match joint.smoothness() {
        Smoothness::Smooth => Tone::Good,
        Smoothness::Slight => Tone::Warning,
        Smoothness::Kink => Tone::Fault,
    }
}

/// Description of the angle that a line makes where it crosses a seam.
fn joint_words(joint: &Joint, (line, seam): (&str, &str)) -> String {
    let degrees = joint.kink.to_degrees();
    let turn = format!("{:.1}\u{b0}", degrees.abs());
    let way = if degrees > 0.0 { "peak" } else { "dip" };
    let how = match joint.smoothness() {
        Smoothness::Smooth => format!("smooth ({turn})"),
        Smoothness::Slight => format!("slight kink {turn}, a {way}"),
        Smoothness::Kink => format!("kink {turn}, a {way}"),
    };
    let step = match joint.step.abs() > SEAM_TOLERANCE {
        true => format!(", step {:.1} mm", 1e3 * joint.step.abs()),
        false => String::new(),
    };
    format!("{line} across {seam}: {how}{step}")
}

/// Descriptions of the lines that cross a seam at its ends, as hems do, with their tones.
pub fn crossing_lines(
    (evaluation, scene): (&Evaluation, &Scene),
    seam: SeamId,
) -> Vec<(String, Tone)> {
    let (pattern, draft) = (evaluation.pattern(), &scene.draft);
    let kept = scene.walked(seam);
    let Some((seam, walk)) = kept.and_then(|kept| kept.walk(draft)) else {
        return Vec::new();
    };
    let joints = walk.joints(evaluation.ease(seam.id));
    let told = joints.iter().flatten().map(|joint| {
        let line = joint.line(pattern, draft);
        (joint_words(joint, (&line, &seam.name)), joint_tone(joint))
    });
    told.collect()
}

/// Adds the text at an end of the seam about the line that crosses it there; if the pieces touch there, also
/// the tangents of that line.
fn mark_joint(
    seen: &Seen<'_>,
    joint: &Joint,
    (contact, fixed): (&Contact, FixedSide),
    maps: &[Affine; 2],
    marks: &mut Vec<Overlay>,
) {
    let [base, moved] = fixed.sides();
    let Some(piece) = seen.draft.pieces.get(joint.pieces[base]) else {
        return;
    };
    let corner = seen.on_table(piece).apply(joint.corners[base]);
    let tone = joint_tone(joint);
    let line = joint.line(seen.pattern, seen.draft);
    let words = joint_words(joint, (&line, &seen.seam.name));
    let whole = seen.walk.lengths()[0];
    let goal = if joint.end == 0 { 0.0 } else { whole };
    if (contact.along[0] - goal).abs() <= AT_END {
        for (side, map) in [(base, &maps[0]), (moved, &maps[1])] {
            let from = joint.corners[side];
            let line = [from, from + joint.leaving[side] * LEAVING];
            let line = line.map(|at| map.apply(at)).to_vec();
            marks.push(Overlay::Stroke(line, tone));
        }
    }
    marks.push(Overlay::Label(corner, words, tone));
}

/// Adds marks for the notches of both pieces, with a note at notches that do not meet their partner.
fn mark_notches(
    seen: &Seen<'_>,
    (contact, fixed): (&Contact, FixedSide),
    maps: &[Affine; 2],
    marks: &mut Vec<Overlay>,
) {
    let sides = fixed.sides();
    for notch in &seen.kept.notches {
        if notch.piece != contact.pieces[notch.side] {
            continue;
        }
        let map = if notch.side == sides[0] {
            maps[0]
        } else {
            maps[1]
        };
        let at = map.apply(notch.at);
        let name = notch_name(seen, notch);
        let (tone, words) = match notch.partner {
            Some(_) if notch.meets() => (Tone::Good, String::new()),
            // If a pair of notches does not meet, only the notch of the first side gets the note.
            Some(_) if notch.side == 1 && notch.partner_piece == Some(contact.pieces[0]) => {
                (Tone::Warning, String::new())
            }
            Some(apart) => {
                let apart = 1e3 * apart.abs();
                (
                    Tone::Warning,
                    format!("{name}: {apart:.1} mm from its partner"),
                )
            }
            None => (Tone::Fault, format!("{name}: no partner")),
        };
        marks.push(Overlay::Pip(at, tone));
        if !words.is_empty() {
            marks.push(Overlay::Label(at, words, tone));
        }
    }
}

fn notch_name(seen: &Seen<'_>, notch: &WalkedNotch) -> String {
    let piece = seen.draft.pieces.get(notch.piece);
    let panel = piece.and_then(|piece| seen.pattern.panel(piece.id.panel));
    let found = panel.and_then(|panel| {
        let mut lineage = seen.pattern.lineage(panel).into_iter();
        lineage.find_map(|own| own.notch(notch.id))
    });
    match (found, piece) {
        (Some(found), Some(piece)) => format!("notch {} of {}", found.name, piece.name),
        _ => "notch".into(),
    }
}

pub(super) fn hint(state: &WalkState, reading: &Reading<'_>) -> String {
    let Some(id) = selected(reading) else {
        return "Click a sewn edge to walk its seam; Esc ends".into();
    };
    let Some(seen) = Seen::new(reading) else {
        let pattern = reading.evaluation.pattern();
        let name = pattern.seam(id).map_or("", |seam| &seam.name);
        return format!(
            "Seam {name} cannot be walked: mend its sides first; Esc puts the tool down"
        );
    };
    let contact = seen.walk.contact(state.along, state.fixed);
    let fixed = seen.piece(&contact, state.fixed.sides()[0]);
    let fixed = fixed.map_or("", |piece| &piece.name);
    format!(
        "{fixed} stays: point or drag along its seam, or type a distance; arrow keys 1 cm, Home and \
         End; Tab: the other piece stays; Esc ends"
    )
}
