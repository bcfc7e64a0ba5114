//! The side of the wearer that an edge is worn on: told by names, body parts, and places on fronts and backs.

use super::edges::SeamEdge;
use super::places::Places;
use crate::{BodyPart, Draft, Facing, Worn};
use std::collections::BTreeSet;

/// Words for left and right. A single letter counts only if another piece has the same name with the other
/// letter.
const SIDES: [[&str; 2]; 6] = [
    ["left", "right"],
    ["links", "rechts"],
    ["gauche", "droite"],
    ["izquierda", "derecha"],
    ["sinistra", "destra"],
    ["l", "r"],
];
/// Words for front and back.
const FACINGS: [[&str; 2]; 3] = [["front", "back"], ["vorder", "rücken"], ["devant", "dos"]];
/// Place across a front or back beyond which an edge belongs to one side of the wearer (1).
const BESIDE: f64 = 0.3;
/// Distance of a placed edge from the middle of the wearer up to which it is on neither side (m).
const MIDDLE: f64 = 0.03;

/// For each edge the side of the wearer: 1 left, -1 right, 0 unknown or in the middle (1).
pub(super) fn wearer_sides(edges: &[SeamEdge], draft: &Draft, places: &Places) -> Vec<f64> {
    let names: BTreeSet<String> = draft.pieces.iter().map(|p| p.name.to_lowercase()).collect();
    let sides: Vec<[f64; 2]> = draft
        .pieces
        .iter()
        .map(|piece| {
            let name = piece.name.to_lowercase();
            let worn = worn_side(&piece.worn);
            let side = if worn == 0.0 {
                named_side(&name, &names)
            } else {
                worn
            };
            [side, facing(&piece.worn, &name)]
        })
        .collect();
    let of = |(k, edge): (usize, &SeamEdge)| {
        let [side, facing] = sides[edge.piece];
        let placed = places.to_the_left(k).unwrap_or(0.0);
        match () {
            () if placed.abs() > MIDDLE => placed.signum(),
            () if side != 0.0 => side,
            // The wearer's left is at the right of a front as seen from outside, and at the left of a back.
            () if edge.across.abs() > BESIDE => facing * edge.across.signum(),
            () => 0.0,
        }
    };
    edges.iter().enumerate().map(of).collect()
}

/// Side of the wearer on which a piece is worn (1).
fn worn_side(worn: &Worn) -> f64 {
    match worn {
        Worn::Wrapped { part, facing, .. } => match (part, facing) {
            (BodyPart::LeftArm | BodyPart::LeftLeg, _) | (BodyPart::Trunk, Facing::Left) => 1.0,
            (BodyPart::RightArm | BodyPart::RightLeg, _) | (BodyPart::Trunk, Facing::Right) => -1.0,
            (BodyPart::Trunk | BodyPart::Head, _) => 0.0,
        },
        Worn::Placed(_) | Worn::Automatic => 0.0,
    }
}

/// 1 for fronts, -1 for backs, 0 for other pieces (1).
fn facing(worn: &Worn, name: &str) -> f64 {
    match worn {
        Worn::Wrapped {
            facing: Facing::Front,
            ..
        } => return 1.0,
        Worn::Wrapped {
            facing: Facing::Back,
            ..
        } => return -1.0,
        Worn::Wrapped { .. } | Worn::Placed(_) | Worn::Automatic => {}
    }
    let said = |k: usize| FACINGS.iter().any(|words| name.contains(words[k]));
    match (said(0), said(1)) {
        (true, false) => 1.0,
        (false, true) => -1.0,
        (true, true) | (false, false) => 0.0,
    }
}

/// Side of the wearer that the name of a piece says, given the names of all pieces in lower case (1).
fn named_side(name: &str, names: &BTreeSet<String>) -> f64 {
    for words in SIDES {
        for (k, side) in [(0, 1.0), (1, -1.0)] {
            let (own, other) = (words[k], words[1 - k]);
            let exchanged =
                |at: usize| format!("{}{other}{}", &name[..at], &name[at + own.len()..]);
            let mut places = name.match_indices(own).map(|(at, _)| exchanged(at));
            if places.any(|name| names.contains(&name)) {
                return side;
            }
            if own.len() > 1 && name.contains(own) && !name.contains(other) {
                return side;
            }
        }
    }
    0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_tell_sides_by_words_and_by_their_counterparts() {
        let names = [
            "lfsleeve",
            "rfsleeve",
            "back",
            "Left collar",
            "Lback",
            "Rback",
            "collar",
        ];
        let names: BTreeSet<String> = names.iter().map(|name| name.to_lowercase()).collect();
        let side = |name: &str| named_side(name, &names);
        assert_eq!(side("lfsleeve"), 1.0);
        assert_eq!(side("rfsleeve"), -1.0);
        assert_eq!(side("left collar"), 1.0);
        assert_eq!(side("lback"), 1.0);
        assert_eq!(side("rback"), -1.0);
        assert_eq!(side("back"), 0.0);
        assert_eq!(side("collar"), 0.0);
    }
}
