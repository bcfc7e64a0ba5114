//! Markers at random, none of them one that a document may not have.

use super::Dice;
use std::sync::Arc;
use toile_pattern::*;

/// A few markers of a pattern.
pub fn markers(dice: &mut Dice, ids: &mut Ids, pattern: &Pattern) -> Vec<Arc<Marker>> {
    let count = dice.below(3);
    (0..count)
        .map(|k| Arc::new(marker(dice, ids.take(), (k, pattern))))
        .filter(|marker| marker.fault().is_none())
        .collect()
}

fn marker(dice: &mut Dice, id: MarkerId, (k, pattern): (usize, &Pattern)) -> Marker {
    let sizes: Vec<Option<SizeId>> = match dice.chance(80) {
        true => pattern.sizes.iter().map(|size| Some(size.id)).collect(),
        false => vec![None],
    };
    let order = sizes.iter().map(|&size| OrderedSize {
        size,
        quantity: 1 + dice.below(3) as u32,
    });
    let order = order.collect();
    let mut placements = Vec::new();
    for panel in &pattern.panels {
        for &size in &sizes {
            if dice.chance(70) {
                placements.push(PiecePlacement {
                    piece: OrderedPiece {
                        panel: panel.id,
                        copy: dice.below(2) as u32,
                        size,
                        garment: dice.below(3) as u32,
                    },
                    at: [dice.finite(), dice.finite()],
                    turn: dice.finite(),
                    flipped: dice.chance(30),
                    locked: dice.chance(30),
                    roll: dice.below(3) as u16,
                });
            }
        }
    }
    let chosen = pattern.fabrics[dice.below(pattern.fabrics.len())].id;
    Marker {
        id,
        name: format!("marker {k}"),
        fabric: chosen,
        keeps_fabric: dice.chance(30),
        cloth: cloth(dice),
        rules: rules(dice, pattern),
        matched: matched(dice, pattern),
        order,
        placements,
    }
}

fn maybe(dice: &mut Dice) -> Option<f64> {
    dice.chance(50).then(|| dice.finite().abs())
}

fn flaws(dice: &mut Dice) -> Option<Vec<Flaw>> {
    let length = |dice: &mut Dice| dice.finite().abs();
    let some = (0..dice.below(3)).map(|_| Flaw {
        at: [length(dice), length(dice)],
        size: [length(dice), length(dice)],
        clearance: length(dice),
    });
    let some = some.collect();
    dice.chance(60).then_some(some)
}

fn cloth(dice: &mut Dice) -> ClothSettings {
    let spreads = [
        Spread::Open,
        Spread::Folded,
        Spread::Tubular,
        Spread::FaceToFace,
    ];
    let naps = [NapRule::None, NapRule::OneWay, NapRule::PerGarment];
    let print = dice.chance(30).then(|| Print {
        repeat: [dice.finite().abs(), 0.0],
        origin: [dice.finite(), dice.finite()],
    });
    let rolls = (0..dice.below(3)).map(|k| Roll {
        name: dice.chance(50).then(|| format!("roll {k}")),
        width: maybe(dice),
        length: maybe(dice),
        price_per_metre: maybe(dice),
        flaws: flaws(dice),
    });
    let rolls = rolls.collect();
    ClothSettings {
        width: maybe(dice),
        length: maybe(dice),
        // Also as it is by default, which stays given.
        selvedge: match dice.chance(30) {
            true => Some(DEFAULT_SELVEDGE),
            false => maybe(dice),
        },
        end_margin: maybe(dice),
        gap: maybe(dice),
        nap: dice.chance(60).then(|| naps[dice.below(3)]),
        tilt: maybe(dice),
        spread: dice.chance(60).then(|| spreads[dice.below(4)]),
        plies: dice.chance(60).then(|| 2 * (1 + dice.below(3) as u32)),
        price_per_metre: maybe(dice),
        currency: dice
            .chance(60)
            .then(|| ["", "EUR", "\"kr\"\n"][dice.below(3)].to_owned()),
        print,
        flaws: flaws(dice),
        rolls: dice.chance(50).then_some(rolls),
    }
}

/// Rules for all pieces, some panels and some copies, no two for the same.
fn rules(dice: &mut Dice, pattern: &Pattern) -> Vec<PieceRule> {
    let mut pieces = vec![RuledPieces::All];
    for panel in &pattern.panels {
        pieces.push(RuledPieces::Panel(panel.id));
        pieces.push(RuledPieces::Copy(panel.id, dice.below(3) as u32));
    }
    let mut rules = Vec::new();
    for pieces in pieces {
        if dice.chance(70) {
            continue;
        }
        let turns = (0..=dice.below(3)).map(|_| Turn(dice.finite()));
        let turns = turns.collect();
        let fabric = |dice: &mut Dice| pattern.fabrics[dice.below(pattern.fabrics.len())].id;
        let also = FurtherFabric {
            fabric: fabric(dice),
            quantity: dice.below(3) as u32,
        };
        rules.push(PieceRule {
            pieces,
            rule: LayingRule {
                gap: maybe(dice),
                block: maybe(dice),
                tilt: maybe(dice),
                turns: dice.chance(40).then_some(turns),
                turn_over: dice.chance(40).then(|| dice.chance(50)),
                on_fold: dice.chance(40).then(|| dice.chance(50)),
                over_flaws: dice.chance(40).then(|| dice.chance(50)),
                on_print: dice.chance(40).then(|| dice.chance(50)),
            },
            fabric: dice.chance(20).then(|| fabric(dice)),
            also: dice.chance(20).then(|| vec![also]),
        });
    }
    rules
}

fn matched(dice: &mut Dice, pattern: &Pattern) -> Vec<MatchedMarks> {
    let marks: Vec<MarkRef> = pattern
        .panels
        .iter()
        .flat_map(|panel| {
            panel.notches.iter().map(|notch| MarkRef {
                panel: panel.id,
                notch: notch.id,
            })
        })
        .collect();
    match marks.len() > 1 && dice.chance(40) {
        true => vec![MatchedMarks(marks)],
        false => Vec::new(),
    }
}
