//! Refuses jobs that cannot be done, before any work.

use crate::error::{ItemProblem, MAX_PIECES, MAX_POINTS, NestingError, Refusal};
use crate::shape::{SNUG, extent, folds_up};
use crate::turns::orientations;
use crate::{Fold, Item, Marker, Mirror, Nap, Placement, Strip, Violation, judge};
use std::collections::BTreeMap;
use toile_geometry::{CrossingKind, PolygonDefect, Vec2};

fn check_outline(item: &Item) -> Option<ItemProblem> {
    let points = item.outline.rings().map(Vec::len).sum();
    if points > MAX_POINTS {
        return Some(ItemProblem::TooManyPoints(points));
    }
    let problem = |defect: &PolygonDefect| match *defect {
        PolygonDefect::NotFinite { .. } => Some(ItemProblem::NotFinite("its outline")),
        PolygonDefect::TooFewPoints { .. } | PolygonDefect::NoArea { .. } => {
            Some(ItemProblem::Empty)
        }
        PolygonDefect::Crossing(c) if c.kind == CrossingKind::Touch => None,
        PolygonDefect::Crossing(c) => Some(ItemProblem::Crosses(c.point)),
        PolygonDefect::StrayHole { hole } => Some(ItemProblem::StrayHole(hole)),
    };
    let found = item.outline.defects().iter().find_map(problem);
    if found == Some(ItemProblem::Empty) {
        // A bow tie has no net area either: the place of the crossing is the better remedy.
        let crossings = item.outline.crossings(16);
        let crossing = crossings.iter().find(|c| c.kind == CrossingKind::Cross);
        return crossing.map(|c| ItemProblem::Crosses(c.point)).or(found);
    }
    found
}

fn check_item(item: &Item, strip: &Strip) -> Option<ItemProblem> {
    if let Some(problem) = check_outline(item) {
        return Some(problem);
    }
    if !item.grain.is_finite() {
        return Some(ItemProblem::NotFinite("its grain"));
    }
    if !item.allowed.turns.iter().all(|t| t.is_finite()) {
        return Some(ItemProblem::NotFinite("an allowed turn"));
    }
    if !item.gap.is_finite() {
        return Some(ItemProblem::NotFinite("its gap"));
    }
    if item.gap < 0.0 {
        return Some(ItemProblem::NegativeGap);
    }
    if item.quantity == 0 {
        return Some(ItemProblem::NoCopies);
    }
    if item.allowed.turns.is_empty() {
        return Some(ItemProblem::NoOrientation);
    }
    if !(0.0..=std::f64::consts::FRAC_PI_4).contains(&item.allowed.tilt) {
        return Some(ItemProblem::Tilt(item.allowed.tilt));
    }
    if item.quantity > MAX_PIECES {
        return Some(ItemProblem::TooMany(item.quantity));
    }
    if let Some(problem) = check_fold(item, strip).or_else(|| check_locks(item)) {
        return Some(problem);
    }
    let copies = 0..item.quantity.min(2);
    copies
        .into_iter()
        .find_map(|copy| check_size(item, strip, copy))
}

fn check_fold(item: &Item, strip: &Strip) -> Option<ItemProblem> {
    item.fold_edge?;
    if strip.fold == Fold::Open {
        return Some(ItemProblem::NoFold);
    }
    if item.allowed.tilt > 0.0 {
        return Some(ItemProblem::TiltOnFold);
    }
    let copies = 0..item.quantity.min(2);
    let lies = |copy: u32| {
        let ways = orientations(item, strip, copy);
        ways.iter()
            .any(|&way| folds_up(item, strip, way) != Some(None))
    };
    (!copies.into_iter().all(lies)).then_some(ItemProblem::WrongSide)
}

pub(crate) fn check_locks(item: &Item) -> Option<ItemProblem> {
    let mut seen = Vec::new();
    for lock in &item.locked {
        let finite = [lock.turn, lock.translation.x, lock.translation.y];
        let sided = match item.allowed.mirror {
            Mirror::Never => !lock.mirrored,
            Mirror::Pairs => lock.mirrored == (lock.copy % 2 == 1),
            Mirror::Always => lock.mirrored,
            Mirror::Free => true,
        };
        let sound = finite.iter().all(|x| x.is_finite())
            && lock.copy < item.quantity
            && sided
            && item.tilt_of(lock.turn).abs() <= item.allowed.tilt + 1e-9
            && !seen.contains(&lock.copy);
        if !sound {
            return Some(ItemProblem::Locked(lock.copy));
        }
        seen.push(lock.copy);
    }
    None
}

fn check_size(item: &Item, strip: &Strip, copy: u32) -> Option<ItemProblem> {
    let ways = orientations(item, strip, copy);
    let forward = |way: &(f64, bool)| strip.nap != Nap::PerBundle || way.0.cos() >= 0.0;
    if !ways.iter().any(forward) {
        return Some(ItemProblem::AgainstNap);
    }
    let sizes: Vec<Vec2> = ways.iter().map(|&way| extent(item, way)).collect();
    let usable = strip.usable_width();
    let needed = sizes.iter().map(|s| s.y).fold(f64::INFINITY, f64::min);
    if needed > usable + SNUG {
        return Some(ItemProblem::TooWide {
            needed,
            usable,
            fabric: strip.layers() * (needed + strip.width - usable),
        });
    }
    let fitting = sizes.iter().filter(|s| s.y <= usable + SNUG);
    let needed = fitting.map(|s| s.x).fold(f64::INFINITY, f64::min);
    let usable = strip.max_length? - 2.0 * strip.end_margin;
    (needed > usable + SNUG).then_some(ItemProblem::TooLong { needed, usable })
}

fn check_strip(strip: &Strip) -> Option<String> {
    let fields = [
        ("width", strip.width),
        ("selvedge", strip.selvedge),
        ("end margin", strip.end_margin),
        ("gap", strip.gap),
        ("length", strip.max_length.unwrap_or(0.0)),
    ];
    for (name, value) in fields {
        if !value.is_finite() || value < 0.0 {
            return Some(format!("the {name} is {value} m; give 0 or more"));
        }
    }
    if strip.usable_width() <= 0.0 {
        return Some(format!(
            "nothing is left of {:.0} mm between two selvedges of {:.0} mm; give the full width of the roll",
            strip.width * 1e3,
            strip.selvedge * 1e3
        ));
    }
    if let Some(stripes) = &strip.stripes {
        let numbers = [stripes.repeat, stripes.origin];
        if !numbers.iter().all(|v| v.x.is_finite() && v.y.is_finite()) || stripes.repeat.min() < 0.0
        {
            return Some("the repeat of the print is not 0 or more; give lengths".into());
        }
    }
    for (k, flaw) in strip.flaws.iter().enumerate() {
        let sound = flaw.outline.is_simple() && flaw.outline.area() > 0.0;
        if !sound || !flaw.clearance.is_finite() || flaw.clearance < 0.0 {
            return Some(format!(
                "defect {} has no sound outline, or a negative clearance; outline the flaw again",
                k + 1
            ));
        }
    }
    None
}

/// Refuses a job that cannot be done, with all its faults.
pub(crate) fn check(items: &[Item], strip: &Strip) -> Result<(), NestingError> {
    check_numbered(items, strip, &|_, copy| copy)
}

/// Function that gives the displayed number of a copy of an item.
type Number<'a> = &'a dyn Fn(usize, u32) -> u32;

/// Does the same check, with other displayed numbers for copies.
pub(crate) fn check_numbered(
    items: &[Item],
    strip: &Strip,
    number: Number<'_>,
) -> Result<(), NestingError> {
    if items.is_empty() {
        return Err(NestingError::NoItems);
    }
    if let Some(problem) = check_strip(strip) {
        return Err(NestingError::Strip(problem));
    }
    let refusal = |(k, item): (usize, &Item)| {
        check_item(item, strip).map(|problem| Refusal {
            item: k,
            name: item.name.clone(),
            problem,
        })
    };
    let mut refusals: Vec<Refusal> = items.iter().enumerate().filter_map(refusal).collect();
    let total: u64 = items.iter().map(|i| u64::from(i.quantity)).sum();
    if refusals.is_empty() && total > u64::from(MAX_PIECES) {
        return Err(NestingError::TooManyPieces(total));
    }
    if refusals.is_empty() {
        refusals = check_places(items, strip, number);
    }
    if refusals.is_empty() {
        Ok(())
    } else {
        Err(NestingError::Refused(refusals))
    }
}

/// Checks the locked copies as a marker of their own: a fault there cannot be repaired by the search.
fn check_places(items: &[Item], strip: &Strip, number: Number<'_>) -> Vec<Refusal> {
    let placed = |(item, what): (usize, &Item)| {
        let place = move |lock: &crate::Locked| Placement {
            item,
            copy: lock.copy,
            turn: lock.turn,
            mirrored: lock.mirrored,
            translation: lock.translation,
        };
        what.locked.iter().map(place).collect::<Vec<_>>()
    };
    let marker = Marker {
        placements: items.iter().enumerate().flat_map(placed).collect(),
        ..Marker::default()
    };
    if marker.placements.is_empty() {
        return Vec::new();
    }
    let laid = |k: usize| (&marker.placements[k], &items[marker.placements[k].item]);
    let copy = |k: usize| number(laid(k).0.item, laid(k).0.copy);
    let name = |k: usize| format!("\"{}\" {}", laid(k).1.name, copy(k));
    let refuse = |k: usize, why: String| Refusal {
        item: laid(k).0.item,
        name: laid(k).1.name.clone(),
        problem: ItemProblem::LockedBadly { copy: copy(k), why },
    };
    let mut refusals = Vec::new();
    for violation in judge(items, strip, &marker).violations {
        let at = match violation {
            Violation::Copy { .. } | Violation::Length { .. } => continue,
            Violation::Overlap { pair, .. }
            | Violation::Gap { pair, .. }
            | Violation::Nap { pair, .. } => pair[1],
            Violation::Outside { placement, .. }
            | Violation::Orientation { placement, .. }
            | Violation::OffFold { placement, .. }
            | Violation::OffPrint { placement, .. }
            | Violation::OnFlaw { placement, .. }
            | Violation::Moved { placement }
            | Violation::Nonsense { placement } => placement,
        };
        refusals.push(refuse(at, violation.in_words(&name)));
    }
    if refusals.is_empty() && strip.nap == Nap::PerBundle {
        refusals.extend(stranded(items, strip, &marker).map(|(k, why)| refuse(k, why)));
    }
    refusals
}

/// A locked placement that forces its garment to run in a direction that another piece of the garment may not
/// take, with the reason.
fn stranded(items: &[Item], strip: &Strip, marker: &Marker) -> Option<(usize, String)> {
    let mut ways: BTreeMap<u32, (usize, bool)> = BTreeMap::new();
    for (k, placement) in marker.placements.iter().enumerate() {
        let bundle = items[placement.item].bundle(placement.copy);
        ways.insert(bundle, (k, placement.turn.cos() >= 0.0));
    }
    items.iter().find_map(|item| {
        (0..item.quantity).find_map(|copy| {
            let &(k, forward) = ways.get(&item.bundle(copy))?;
            let mut own = orientations(item, strip, copy).into_iter();
            let can = own.any(|way| (way.0.cos() >= 0.0) == forward);
            (!can).then(|| {
                let why = format!(
                    "piece \"{}\" of its garment may not run that way; turn the locked piece round",
                    item.name
                );
                (k, why)
            })
        })
    })
}
