//! Ways of putting garments on: as their patterns say, and another way for one that fell off the body.

use crate::outfit::DraftedPart;
use std::sync::Arc;
use toile_assembly::{PlacementBody, body_part_by_name};
use toile_pattern::{BodyPart, Draft, Facing, Worn};

/// A way of putting garments on a body.
pub(crate) struct PutOn {
    /// The garments as they are to be placed.
    pub parts: Arc<Vec<DraftedPart>>,
    /// Whether garments that would otherwise hang from the waist are hung from the chest.
    pub hangs_from_chest: bool,
}

impl PutOn {
    /// Puts the garments on as their patterns say.
    pub fn as_given(parts: Arc<Vec<DraftedPart>>) -> Self {
        Self {
            parts,
            hangs_from_chest: false,
        }
    }

    /// Another way of putting the garments on, with words for the first way and for this one. If there is no
    /// other way, the error is the words for the first way.
    pub fn otherwise(parts: &[DraftedPart]) -> Result<(Self, [&'static str; 2]), String> {
        let any = |is: fn(&Worn) -> bool| {
            let pieces = parts.iter().flat_map(|part| &part.draft.pieces);
            pieces.filter(|piece| piece.sewn).any(|p| is(&p.worn))
        };
        let changed = |change: fn(&mut Worn)| {
            let change_all = |part: &DraftedPart| {
                let mut draft: Draft = (*part.draft).clone();
                draft.pieces.iter_mut().for_each(|p| change(&mut p.worn));
                DraftedPart {
                    draft: Arc::new(draft),
                    ..part.clone()
                }
            };
            Self::as_given(Arc::new(parts.iter().map(change_all).collect()))
        };
        if any(|worn| matches!(worn, Worn::Placed(_))) {
            let otherwise = changed(|worn| {
                if matches!(worn, Worn::Placed(_)) {
                    *worn = Worn::Automatic;
                }
            });
            let words = [
                "where its file places its panels",
                "wrapped round the body by the names and seams of its panels",
            ];
            return Ok((otherwise, words));
        }
        if any(is_over) {
            let otherwise = changed(|worn| {
                if let Worn::Wrapped { facing, level, .. } = worn
                    && *facing == Facing::Over
                {
                    (*facing, *level) = (Facing::Around, None);
                }
            });
            return Ok((otherwise, ["over the head", "round the trunk"]));
        }
        if any(has_level) {
            let otherwise = changed(|worn| {
                if let Worn::Wrapped { level, .. } = worn {
                    *level = None;
                }
            });
            let words = ["at the level given", "at the level its kind hangs from"];
            return Ok((otherwise, words));
        }
        Self::from_chest(parts)
    }

    /// Hangs garments from the chest instead of the waist; refused if all pieces are known to go round other
    /// parts of the body than the trunk.
    fn from_chest(parts: &[DraftedPart]) -> Result<(Self, [&'static str; 2]), String> {
        let told = told_body_parts(parts);
        if !told.is_empty() && !told.contains(&BodyPart::Trunk) {
            let each: Vec<&str> = told.into_iter().map(place_on).collect();
            return Err(each.join(" and "));
        }
        let otherwise = Self {
            parts: Arc::new(parts.to_vec()),
            hangs_from_chest: true,
        };
        Ok((otherwise, ["from the waist", "from the chest"]))
    }

    /// The body that garments are placed on. If they hang from the chest, the waist has the height of the
    /// chest.
    pub fn body<'a>(&self, mut body: PlacementBody<'a>) -> PlacementBody<'a> {
        if self.hangs_from_chest {
            body.levels.waist = body.levels.chest;
        }
        body
    }
}

/// The body parts that sewn pieces go round, as far as the patterns or the names of the pieces tell, in the
/// order of the pieces. Pieces of which nothing is told go round the part that their neighbours go round, or
/// else the trunk.
fn told_body_parts(parts: &[DraftedPart]) -> Vec<BodyPart> {
    let pieces = parts.iter().flat_map(|part| &part.draft.pieces);
    let mut told = Vec::new();
    for piece in pieces.filter(|piece| piece.sewn) {
        let part = match piece.worn {
            Worn::Wrapped { part, .. } => Some(part),
            Worn::Automatic => body_part_by_name(piece),
            Worn::Placed(_) => None,
        };
        told.extend(part.filter(|part| !told.contains(part)));
    }
    told
}

/// Words for a garment that goes round one part of the body.
fn place_on(part: BodyPart) -> &'static str {
    match part {
        BodyPart::Trunk => "round the trunk",
        BodyPart::LeftArm => "round the left arm",
        BodyPart::RightArm => "round the right arm",
        BodyPart::LeftLeg => "round the left leg",
        BodyPart::RightLeg => "round the right leg",
        BodyPart::Head => "round the head",
    }
}

fn is_over(worn: &Worn) -> bool {
    matches!(worn, Worn::Wrapped { facing, .. } if *facing == Facing::Over)
}

/// Whether a piece that goes round any body part but an arm has a level of its own.
fn has_level(worn: &Worn) -> bool {
    matches!(worn, Worn::Wrapped { part, level, .. }
        if level.is_some() && !matches!(part, BodyPart::LeftArm | BodyPart::RightArm))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Project;
    use toile_geometry::Rigid;
    use toile_pattern::{Pattern, Piece, PieceId};

    /// A garment of sewn pieces with names and places.
    fn garment(pieces: &[(&str, Worn)]) -> Vec<DraftedPart> {
        let mut pattern = Pattern::new("garment");
        let mut piece = |&(name, worn): &(&str, Worn)| Piece {
            id: PieceId {
                panel: pattern.ids.take(),
                copy: 0,
            },
            name: name.to_owned(),
            outline: Vec::new(),
            holes: Vec::new(),
            internal_lines: Vec::new(),
            notches: Vec::new(),
            darts: Vec::new(),
            pressed: Vec::new(),
            folds: Vec::new(),
            grain: 0.0,
            fabric: 0,
            worn,
            sewn: true,
        };
        let draft = Draft {
            pieces: pieces.iter().map(&mut piece).collect(),
            ..Draft::default()
        };
        let project = Project::default();
        vec![DraftedPart::own(&project, Arc::new(draft), Arc::default())]
    }

    fn round(part: BodyPart) -> Worn {
        Worn::Wrapped {
            part,
            facing: Facing::Around,
            level: None,
        }
    }

    #[test]
    fn only_what_goes_round_the_trunk_is_hung_from_the_chest() {
        let trunk = ("waistband", Worn::Automatic);
        let leg = ("front", round(BodyPart::LeftLeg));
        let arm = ("right sleeve", Worn::Automatic);
        let unnamed = ("a", Worn::Automatic);
        for pieces in [
            &[trunk, leg][..],
            &[unnamed],
            &[trunk],
            &[arm, unnamed, trunk],
        ] {
            let (otherwise, words) = PutOn::otherwise(&garment(pieces)).ok().unwrap();
            assert!(otherwise.hangs_from_chest, "{pieces:?}");
            assert_eq!(words, ["from the waist", "from the chest"]);
        }
        for (pieces, place) in [
            (&[leg, leg][..], "round the left leg"),
            (
                &[arm, unnamed, leg],
                "round the right arm and round the left leg",
            ),
        ] {
            let place_told = PutOn::otherwise(&garment(pieces)).err().unwrap();
            assert_eq!(place_told, place);
        }
        // Placed pieces are wrapped instead.
        let placed = ("front", Worn::Placed(Rigid::identity()));
        let (otherwise, _) = PutOn::otherwise(&garment(&[placed])).ok().unwrap();
        assert!(!otherwise.hangs_from_chest);
    }
}
