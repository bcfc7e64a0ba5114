//! The body part of every piece: as the document says, else from its name, else from its seams and size.

use crate::Diagnostic;
use crate::flat_pieces::{FlatPiece, Tie};
use crate::gores::ring_facings;
use crate::mesh::PieceMeshes;
use crate::wearer_side::wearer_sides;
use toile_geometry::Rigid;
use toile_pattern::{BodyPart, Draft, Facing, Piece, Worn};

/// The placement rule of a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Role {
    /// Placed as the file says.
    Placed(Rigid),
    /// Wrapped round a body part.
    Wrapped {
        part: BodyPart,
        facing: Facing,
        level: Option<f64>,
    },
}

/// Determines the roles of all meshed pieces.
pub(crate) fn roles(
    (draft, meshes): (&Draft, &PieceMeshes),
    (laid, ties): (&[FlatPiece], &[Tie]),
    diagnostics: &mut Vec<Diagnostic>,
) -> Vec<Role> {
    let mut known: Vec<Option<Role>> = Vec::new();
    for mesh in &meshes.pieces {
        let piece = &draft.pieces[mesh.draft_piece];
        known.push(match piece.worn {
            Worn::Placed(place) => Some(Role::Placed(place)),
            Worn::Wrapped {
                part,
                facing,
                level,
            } => Some(Role::Wrapped {
                part,
                facing,
                level,
            }),
            Worn::Automatic => None,
        });
    }
    let guessed: Vec<usize> = (0..known.len()).filter(|&k| known[k].is_none()).collect();
    if !guessed.is_empty() {
        let pieces = meshes.pieces.iter();
        let pieces: Vec<(&Piece, Option<&Role>)> = pieces
            .zip(&known)
            .map(|(mesh, role)| (&draft.pieces[mesh.draft_piece], role.as_ref()))
            .collect();
        let facing: Vec<_> = pieces.iter().map(told_facing).collect();
        let told: Vec<_> = pieces.iter().map(told_side).collect();
        let sides = wearer_sides((meshes, laid), ties, &facing, &told);
        let in_rings = ring_facings(laid, ties, &facing);
        let guesses = pieces.iter().zip(sides).zip(in_rings);
        let guesses: Vec<Guess> = guesses
            .map(|(((piece, _), left), in_ring)| Guess::from_name(piece, left).on_trunk(in_ring))
            .collect();
        let sewn = SewnLengths::new(meshes);
        let areas: Vec<f64> = meshes.pieces.iter().map(crate::PieceMesh::area).collect();
        guess(&mut known, &guesses, &sewn, (&areas, draft, meshes));
        for &k in &guessed {
            let name = &draft.pieces[meshes.pieces[k].draft_piece].name;
            if let Some(Role::Wrapped { part, facing, .. }) = known[k] {
                diagnostics.push(Diagnostic::note(
                    name,
                    format!("its place is not given: put on {part:?}, {facing:?}"),
                    "say where it is worn if that is wrong",
                ));
            }
        }
    }
    known
        .into_iter()
        .map(|role| {
            role.unwrap_or(Role::Wrapped {
                part: BodyPart::Trunk,
                facing: Facing::Front,
                level: None,
            })
        })
        .collect()
}

/// The body part suggested by the name of a piece.
pub fn body_part_by_name(piece: &Piece) -> Option<BodyPart> {
    Guess::from_name(piece, told_side(&(piece, None))).part
}

/// The body part and facing suggested by the name of a piece.
#[derive(Clone, Copy, Debug, Default)]
struct Guess {
    part: Option<BodyPart>,
    facing: Option<Facing>,
}

/// Words of a name: sequences of letters, also split where a lower-case letter is followed by a capital.
fn words(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut small = false;
    for c in name.chars() {
        if !c.is_alphabetic() || (small && c.is_uppercase()) {
            words.push(String::new());
        }
        if c.is_alphabetic()
            && let Some(word) = words.last_mut()
        {
            word.extend(c.to_lowercase());
        }
        small = c.is_lowercase();
    }
    words.retain(|w| !w.is_empty());
    words
}

/// The facing of a piece according to the document, else to its name.
fn told_facing((piece, role): &(&Piece, Option<&Role>)) -> Option<Facing> {
    match role {
        Some(Role::Wrapped { facing, .. }) => Some(*facing),
        Some(Role::Placed(_)) => None,
        None => Guess::from_name(piece, None).facing,
    }
}

/// Whether a piece goes on the wearer's left according to the document, else to its name.
fn told_side((piece, role): &(&Piece, Option<&Role>)) -> Option<bool> {
    match role {
        Some(Role::Wrapped { part, facing, .. }) => match (part, facing) {
            (BodyPart::LeftArm | BodyPart::LeftLeg, _) => Some(true),
            (BodyPart::RightArm | BodyPart::RightLeg, _) => Some(false),
            (_, Facing::Left) => Some(true),
            (_, Facing::Right) => Some(false),
            _ => None,
        },
        Some(Role::Placed(_)) => None,
        None => {
            let words = words(&piece.name);
            let has = |list: [&str; 2]| words.iter().any(|w| list.contains(&w.as_str()));
            let is_left = has(["left", "l"]).then_some(true);
            is_left.or(has(["right", "r"]).then_some(false))
        }
    }
}

impl Guess {
    /// Guesses from the name; `left` is whether the piece goes on the wearer's left, if known.
    fn from_name(piece: &Piece, left: Option<bool>) -> Self {
        let words = words(&piece.name);
        let has = |list: &[&str]| words.iter().any(|w| list.contains(&w.as_str()));
        let holds = |list: &[&str]| words.iter().any(|w| list.iter().any(|p| w.contains(p)));
        let left = left.unwrap_or(piece.id.copy.is_multiple_of(2));
        let leg = holds(&["pant", "trouser", "jean", "short", "legging"]) || has(&["leg"]);
        let part = if leg && !holds(&["waist", "band", "wb"]) {
            Some(if left {
                BodyPart::LeftLeg
            } else {
                BodyPart::RightLeg
            })
        } else if holds(&["sleeve", "cuff"]) || has(&["arm"]) {
            Some(if left {
                BodyPart::LeftArm
            } else {
                BodyPart::RightArm
            })
        } else if holds(&["hood", "collar"]) || has(&["neckband"]) {
            Some(BodyPart::Head)
        } else if holds(&[
            "skirt", "waist", "band", "bodice", "torso", "yoke", "poncho", "cape", "body", "front",
            "back",
        ]) || has(&["wb"])
        {
            Some(BodyPart::Trunk)
        } else {
            None
        };
        let facing = if holds(&["front", "ftorso"]) || has(&["f", "fr"]) {
            Some(Facing::Front)
        } else if holds(&["back", "btorso"]) || has(&["b", "bk"]) {
            Some(Facing::Back)
        } else if holds(&["poncho", "cape"]) {
            Some(Facing::Over)
        } else if holds(&["hood"]) || has(&["side"]) {
            Some(if left { Facing::Left } else { Facing::Right })
        } else if holds(&["sleeve", "cuff", "collar", "band", "wb"]) {
            Some(Facing::Around)
        } else {
            None
        };
        Self { part, facing }
    }

    /// Adds a facing to a guess for a piece of the trunk whose name does not tell one.
    fn on_trunk(mut self, facing: Option<Facing>) -> Self {
        if matches!(self.part, None | Some(BodyPart::Trunk)) {
            self.facing = self.facing.or(facing);
        }
        self
    }
}

/// Number of stitches between each pair of meshed pieces.
pub(crate) struct SewnLengths {
    count: usize,
    table: Vec<f64>,
}

impl SewnLengths {
    pub fn new(meshes: &PieceMeshes) -> Self {
        let count = meshes.pieces.len();
        let mut ends = Vec::new();
        let mut total = 0;
        for piece in &meshes.pieces {
            total += piece.points.len();
            ends.push(total);
        }
        let piece_of = |v: u32| ends.partition_point(|&e| e <= v as usize);
        let mut table = vec![0.0; count * count];
        for stitch in &meshes.stitches {
            let [a, b] = stitch.vertices.map(piece_of);
            table[a * count + b] += 1.0;
            table[b * count + a] += 1.0;
        }
        Self { count, table }
    }

    pub fn between(&self, a: usize, b: usize) -> f64 {
        self.table[a * self.count + b]
    }
}

fn opposite(facing: Facing) -> Facing {
    match facing {
        Facing::Front => Facing::Back,
        Facing::Back => Facing::Front,
        Facing::Left => Facing::Right,
        Facing::Right => Facing::Left,
        Facing::Around | Facing::Over => facing,
    }
}

/// Fills in unknown roles, pieces with telling names first, then the largest. The body part comes from the
/// name, else from the piece with the most common stitches. The facing comes from the name, else from the
/// ring of gores, else it is opposite to that piece.
fn guess(
    known: &mut [Option<Role>],
    guesses: &[Guess],
    sewn: &SewnLengths,
    (areas, draft, meshes): (&[f64], &Draft, &PieceMeshes),
) {
    let mut order: Vec<usize> = (0..known.len()).filter(|&k| known[k].is_none()).collect();
    // Pieces with telling names first: the others are derived from them.
    order.sort_by(|&a, &b| {
        let certainty = |k: usize| {
            usize::from(guesses[k].part.is_some()) + usize::from(guesses[k].facing.is_some())
        };
        certainty(b)
            .cmp(&certainty(a))
            .then(areas[b].total_cmp(&areas[a]))
            .then(a.cmp(&b))
    });
    for k in order {
        let partner = (0..known.len())
            .filter(|&j| j != k && known[j].is_some() && sewn.between(k, j) > 0.0)
            .max_by(|&i, &j| {
                sewn.between(k, i)
                    .total_cmp(&sewn.between(k, j))
                    .then(j.cmp(&i))
            })
            .and_then(|j| match known[j] {
                Some(Role::Wrapped { part, facing, .. }) => Some((part, facing)),
                _ => None,
            });
        let piece = &draft.pieces[meshes.pieces[k].draft_piece];
        let alone = meshes.pieces.len() == 1;
        let part = guesses[k]
            .part
            .or(partner.map(|p| p.0))
            .unwrap_or(BodyPart::Trunk);
        let facing = guesses[k].facing.unwrap_or_else(|| {
            if alone && !piece.holes.is_empty() {
                Facing::Over
            } else if sewn.between(k, k) > 0.0 && alone {
                Facing::Around
            } else {
                partner.map_or(Facing::Front, |p| opposite(p.1))
            }
        });
        known[k] = Some(Role::Wrapped {
            part,
            facing,
            level: None,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_split_into_words() {
        assert_eq!(words("left_btorso"), ["left", "btorso"]);
        assert_eq!(words("skirtFront 2"), ["skirt", "front"]);
        assert_eq!(words(""), Vec::<String>::new());
    }
}
