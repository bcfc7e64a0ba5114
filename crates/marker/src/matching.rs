//! Matches marks of pieces to the same place of a print, so that stripes and checks meet at seams.
//!
//! An item has one match point in one set. Sets of marks that share pieces are joined into one set: if piece
//! i has mark m of a set and anchor a, then piece j with mark m' of that set has the anchor a' = a - m + m',
//! in the axes of the grain. This holds only if i and j lie the same way up, so pieces with several marks
//! make their garment run one way.

use crate::MarkerError;
use crate::marks::turned;
use crate::options::FabricPlan;
use crate::pieces::PieceToCut;
use std::collections::BTreeMap;
use toile_geometry::Vec2;
use toile_nesting::{Item, MatchPoint, Mirror, NestingError, Phase, Stripes};

/// Tolerance for marks of one set (m).
const MISS: f64 = 1e-6;

/// Sets the match point of every item with marks. `order` gives the piece to cut of each item.
pub(crate) fn match_up(
    items: &mut [Item],
    order: &[usize],
    (to_cut, plan): (&[PieceToCut], &FabricPlan),
) -> Result<(), MarkerError> {
    let Some(stripes) = plan.rolls.iter().find_map(|r| r.strip.stripes) else {
        return Ok(());
    };
    let marks: Vec<Vec<(usize, Vec2)>> = order
        .iter()
        .map(|&k| {
            let grain = to_cut[k].cut.grain;
            let straight = |m: &(usize, Vec2)| (m.0, turned(m.1, -grain));
            to_cut[k].marks.iter().map(straight).collect()
        })
        .collect();
    let garment = |k: usize| to_cut[order[k]].bundles.first().copied().unwrap_or(0);
    let mut members: BTreeMap<(u32, usize), Vec<(usize, Vec2)>> = BTreeMap::new();
    for (k, marks) in marks.iter().enumerate() {
        for &(set, mark) in marks {
            let set = members.entry((garment(k), set)).or_default();
            set.push((k, mark));
        }
    }
    let mut anchors: Vec<Option<Vec2>> = vec![None; items.len()];
    let mut number = 0;
    for root in 0..items.len() {
        let (None, Some(first)) = (anchors[root], marks[root].first()) else {
            continue;
        };
        anchors[root] = Some(first.1);
        let mut joined = vec![root];
        let mut next = 0;
        while let Some(&one) = joined.get(next) {
            next += 1;
            let Some(anchor) = anchors[one] else { continue };
            for &(set, mark) in &marks[one] {
                for &(other, theirs) in &members[&(garment(one), set)] {
                    let expected = anchor - mark + theirs;
                    match anchors[other] {
                        None => {
                            anchors[other] = Some(expected);
                            joined.push(other);
                        }
                        Some(has) if missed(has - expected, &stripes) => {
                            return Err(cannot_meet(&items[one], &items[other]).into());
                        }
                        Some(_) => {}
                    }
                }
            }
        }
        let chained = joined.iter().any(|&k| marks[k].len() > 1);
        for &k in &joined {
            let Some(anchor) = anchors[k] else { continue };
            items[k].match_point = Some(MatchPoint {
                point: turned(anchor, items[k].grain),
                phase: Phase::Set(number),
            });
            if chained && items[k].allowed.mirror == Mirror::Free && stripes.repeat.y > 0.0 {
                items[k].allowed.mirror = Mirror::Never;
            }
        }
        number += 1;
    }
    Ok(())
}

/// Whether pieces must lie the same way up because a piece has several marks.
pub(crate) fn runs_one_way(to_cut: &[PieceToCut]) -> bool {
    to_cut.iter().any(|w| w.marks.len() > 1)
}

/// Whether an offset differs from a whole number of repeats.
fn missed(apart: Vec2, stripes: &Stripes) -> bool {
    (0..2).any(|axis| {
        let repeat = stripes.repeat[axis];
        let off = apart[axis].rem_euclid(if repeat > 0.0 { repeat } else { 1.0 });
        repeat > 0.0 && off.min(repeat - off) > MISS
    })
}

fn cannot_meet(one: &Item, other: &Item) -> NestingError {
    NestingError::Strip(format!(
        "the print cannot meet at all marks of \"{}\" and \"{}\": other marks hold them already; match fewer marks, or move a notch",
        one.name, other.name
    ))
}
