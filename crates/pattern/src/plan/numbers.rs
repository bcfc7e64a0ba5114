//! Reads and sets the numbers of parts, each by its address.

use super::impossible;
use super::lookup::{after, refuse_faults};
use super::moving::added;
use super::number_address::{
    MarkNumber, NumberAddress, OperationNumber, PointNumber, Slot, SpanEnd,
};
use super::seam::SeamSide;
use crate::{
    Code, Edit, EditError, Evaluation, Number, OperationId, OperationKind, PartId, Pattern, Place,
    SizeId, Want,
};

/// A number of a part, for an inspector.
#[derive(Clone, Debug, PartialEq)]
pub struct NumberEntry {
    /// Where it stands.
    pub place: NumberAddress,
    /// What it is called beside its field.
    pub label: &'static str,
    /// What it must be.
    pub want: Want,
    /// The number; nothing where it may be left out and is.
    pub number: Option<Number>,
}

/// The numbers of a part, in the order they are shown; none if it has none or is not there.
pub fn numbers_of(evaluation: &Evaluation, part: PartId) -> Vec<NumberEntry> {
    let pattern = evaluation.pattern();
    let entry = |place: NumberAddress| {
        let mut entity = place.entity(pattern)?;
        let number = match place.slot(&mut entity)? {
            Slot::Always(number) => Some(number.clone()),
            Slot::Optional(number) => number.clone(),
        };
        Some(NumberEntry {
            place,
            label: place.label(),
            want: place.want(),
            number,
        })
    };
    candidates(pattern, part)
        .into_iter()
        .filter_map(entry)
        .collect()
}

/// The number at a place; nothing if it is not there or left out.
pub fn number_at(pattern: &Pattern, place: &NumberAddress) -> Option<Number> {
    let mut entity = place.entity(pattern)?;
    match place.slot(&mut entity)? {
        Slot::Always(number) => Some(number.clone()),
        Slot::Optional(number) => number.clone(),
    }
}

/// The edits that set the number at a place.
///
/// # Errors
/// The place is not there; the number has no value there, the wrong dimension, or needs itself.
pub fn set_number(
    evaluation: &Evaluation,
    place: &NumberAddress,
    number: Number,
) -> Result<Vec<Edit>, EditError> {
    let mut entity = entity(evaluation, place)?;
    match place.slot(&mut entity).ok_or_else(|| missing(place))? {
        Slot::Always(old) => *old = number,
        Slot::Optional(old) => *old = Some(number),
    }
    let edits = vec![Edit::Put(entity)];
    refuse_valueless(evaluation, &edits, place)?;
    Ok(edits)
}

/// The edits that bring the number at a place to a value [m], [rad] or plain for the measurements on
/// show: a value is set, a formula stays and gets something added.
///
/// # Errors
/// The place is not there or has no number; the number has no value now; the new one has none.
pub fn adjust_number(
    evaluation: &Evaluation,
    place: &NumberAddress,
    to: f64,
) -> Result<Vec<Edit>, EditError> {
    let number = number_at(evaluation.pattern(), place).ok_or_else(|| missing(place))?;
    let now = match place {
        NumberAddress::Variable(id) => evaluation.variable(*id).map(|found| found.0),
        _ => evaluation.number(&number, place.want()),
    };
    let now = now.ok_or_else(|| {
        impossible(
            format!("the {} of {} has no value", place.label(), place.part()),
            "mend its formula first, or give it another number",
        )
    })?;
    set_number(evaluation, place, added(&number, to - now))
}

/// The edits that give a number a value of its own in one size [m], [rad] or plain, or take it away
/// again; in all other sizes it stays.
///
/// # Errors
/// The size or the place is not there, or has no number; the value is not finite.
pub fn set_number_in_size(
    evaluation: &Evaluation,
    place: &NumberAddress,
    (size, value): (SizeId, Option<f64>),
) -> Result<Vec<Edit>, EditError> {
    let pattern = evaluation.pattern();
    if !pattern.sizes.iter().any(|known| known.id == size) {
        return Err(EditError::Missing(size.to_string()));
    }
    let number = number_at(pattern, place).ok_or_else(|| missing(place))?;
    let (usual, mut sizes) = match number {
        Number::PerSize { usual, sizes } => (usual, sizes),
        other => (Box::new(other), Vec::new()),
    };
    let at = sizes.iter().position(|own| own.0 == size);
    match (at, value) {
        (Some(k), Some(value)) => sizes[k].1 = value,
        (Some(k), None) => {
            sizes.remove(k);
        }
        (None, Some(value)) => sizes.push((size, value)),
        (None, None) => {}
    }
    let number = match sizes.is_empty() {
        true => *usual,
        false => Number::PerSize { usual, sizes },
    };
    set_number(evaluation, place, number)
}

/// The edits that leave a number out: an edge's allowance is then its panel's, a spline's handles
/// are as they are drawn, a level is found by the program.
///
/// # Errors
/// The place is not there, or its number cannot be left out.
pub fn clear_number(
    evaluation: &Evaluation,
    place: &NumberAddress,
) -> Result<Vec<Edit>, EditError> {
    let mut entity = entity(evaluation, place)?;
    match place.slot(&mut entity).ok_or_else(|| missing(place))? {
        Slot::Optional(old) => *old = None,
        Slot::Always(_) => {
            return Err(impossible(
                format!("the {} cannot be left out", place.label()),
                "give it a number, zero if need be",
            ));
        }
    }
    Ok(vec![Edit::Put(entity)])
}

fn entity(evaluation: &Evaluation, place: &NumberAddress) -> Result<crate::Entity, EditError> {
    let entity = place.entity(evaluation.pattern());
    entity.ok_or_else(|| missing(place))
}

fn missing(place: &NumberAddress) -> EditError {
    EditError::Missing(format!("the {} of {}", place.label(), place.part()))
}

/// Refuses edits after which the number at a place has a fault of its own or needs itself. A
/// number that waits for other parts is taken.
pub(super) fn refuse_valueless(
    evaluation: &Evaluation,
    edits: &[Edit],
    place: &NumberAddress,
) -> Result<(), EditError> {
    let after = after(evaluation, edits)?;
    let old = evaluation.diagnostics();
    let cycles = after.diagnostics().into_iter();
    let mut cycles = cycles.filter(|found| found.code == Code::Cycle && !old.contains(found));
    if let Some(found) = cycles.next() {
        return Err(impossible(found.message, found.hint));
    }
    if let NumberAddress::Variable(id) = place {
        return refuse_faults(evaluation, &after, &[Place::Variable(*id)]);
    }
    let Some(number) = number_at(after.pattern(), place) else {
        return Ok(());
    };
    let (_, faults) = after.number_of_kind(&number, place.want(), &Place::Pattern, place.label());
    match faults.into_iter().next() {
        Some(found) => Err(impossible(found.message, found.hint)),
        None => Ok(()),
    }
}

/// The numbers the cuts of a spread or the lines of pleats may have.
fn cut_numbers(pattern: &Pattern, id: OperationId, marks: [MarkNumber; 2]) -> Vec<OperationNumber> {
    let all = pattern.panels.iter().flat_map(|panel| &panel.operations);
    let count = all
        .filter(|operation| operation.id == id)
        .map(|operation| match &operation.kind {
            OperationKind::Spread { cuts, .. } => cuts.len(),
            OperationKind::Pleat { pleats, .. } => pleats.len(),
            _ => 0,
        });
    let mut numbers = Vec::new();
    for k in 0..count.sum() {
        for end in [SpanEnd::From, SpanEnd::To] {
            numbers.extend(marks.map(|mark| OperationNumber::Cut(k, end, mark)));
            numbers.push(OperationNumber::Opening(k, end));
        }
    }
    numbers
}

/// Places at which a part may have a number.
fn candidates(pattern: &Pattern, part: PartId) -> Vec<NumberAddress> {
    let marks = [MarkNumber::Distance, MarkNumber::Share];
    let owner = |own: &dyn Fn(&crate::Panel) -> bool| {
        let found = pattern.panels.iter().find(|panel| own(panel));
        found.map(|panel| panel.id)
    };
    match part {
        PartId::Variable(id) => vec![NumberAddress::Variable(id)],
        PartId::Point(id) => [
            PointNumber::X,
            PointNumber::Y,
            PointNumber::Angle,
            PointNumber::Distance,
            PointNumber::Along,
            PointNumber::Aside,
            PointNumber::Share,
        ]
        .map(|number| NumberAddress::Point(id, number))
        .to_vec(),
        PartId::Curve(id) => vec![NumberAddress::Bulge(id), NumberAddress::ToLength(id)],
        PartId::Panel(id) => vec![
            NumberAddress::Grain(id),
            NumberAddress::Allowance(id),
            NumberAddress::Level(id),
        ],
        PartId::Edge(id) => {
            let panel = owner(&|panel| panel.edge(id).is_some());
            let place = panel.map(|panel| NumberAddress::EdgeAllowance(panel, id));
            place.into_iter().collect()
        }
        PartId::Notch(id) => {
            let panel = owner(&|panel| panel.notches.iter().any(|notch| notch.id == id));
            let places = panel.map(|panel| marks.map(|m| NumberAddress::Notch(panel, id, m)));
            places.into_iter().flatten().collect()
        }
        PartId::Operation(id) => {
            let panel = owner(&|panel| panel.operations.iter().any(|known| known.id == id));
            let mut numbers: Vec<OperationNumber> = Vec::new();
            numbers.extend(marks.map(OperationNumber::Mouth));
            numbers.extend([
                OperationNumber::Intake,
                OperationNumber::Depth,
                OperationNumber::Widest,
            ]);
            numbers.extend(marks.map(OperationNumber::FoldStart));
            numbers.extend(marks.map(OperationNumber::FoldEnd));
            numbers.extend([OperationNumber::Share, OperationNumber::Back]);
            numbers.extend(marks.map(OperationNumber::Held));
            numbers.extend(cut_numbers(pattern, id, marks));
            let places = |panel| {
                let numbers = numbers.into_iter();
                numbers.map(move |number| NumberAddress::Operation(panel, id, number))
            };
            panel.map(places).into_iter().flatten().collect()
        }
        PartId::Seam(id) => {
            let mut places = vec![NumberAddress::Ease(id)];
            let seam = pattern.seam(id);
            for side in [SeamSide::First, SeamSide::Second] {
                let count = seam.map_or(0, |seam| seam.sides[side.index()].len());
                for k in 0..count {
                    for end in [SpanEnd::From, SpanEnd::To] {
                        let place = |mark| NumberAddress::Span(id, side, k, end, mark);
                        places.extend(marks.map(place));
                    }
                }
            }
            places
        }
        PartId::Size(_)
        | PartId::Fabric(_)
        | PartId::Sheet(_)
        | PartId::Line(_)
        | PartId::Marker(_)
        | PartId::Guide(_) => Vec::new(),
    }
}
