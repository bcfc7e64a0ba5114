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
                });
            }
        }
    }
    Marker {
        id,
        name: format!("marker {k}"),
        cloth: cloth(dice, pattern),
        order,
        placements,
    }
}

fn cloth(dice: &mut Dice, pattern: &Pattern) -> MarkerCloth {
    let usual = MarkerCloth::of(pattern.fabrics[dice.below(pattern.fabrics.len())].id);
    let length = |dice: &mut Dice| dice.finite().abs();
    let maybe = |dice: &mut Dice| dice.chance(50).then(|| dice.finite().abs());
    let spreads = [
        Spread::Open,
        Spread::Folded,
        Spread::Tubular,
        Spread::FaceToFace,
    ];
    let naps = [NapRule::None, NapRule::OneWay, NapRule::PerGarment];
    let (width, at_hand, price_per_metre) = (maybe(dice), maybe(dice), maybe(dice));
    let print = dice.chance(30).then(|| Print {
        repeat: [dice.finite().abs(), 0.0],
        origin: [dice.finite(), dice.finite()],
    });
    let flaws = (0..dice.below(3)).map(|_| Flaw {
        at: [length(dice), length(dice)],
        size: [length(dice), length(dice)],
        clearance: length(dice),
    });
    let flaws = flaws.collect();
    MarkerCloth {
        keeps_fabric: dice.chance(30),
        width,
        length: at_hand,
        selvedge: if dice.chance(50) {
            length(dice)
        } else {
            usual.selvedge
        },
        end_margin: length(dice),
        gap: length(dice),
        nap: dice.chance(60).then(|| naps[dice.below(3)]),
        tilt: if dice.chance(30) { length(dice) } else { 0.0 },
        spread: spreads[dice.below(4)],
        plies: 2 * (1 + dice.below(3) as u32),
        price_per_metre,
        currency: ["", "EUR", "\"kr\"\n"][dice.below(3)].to_owned(),
        print,
        flaws,
        ..usual
    }
}
