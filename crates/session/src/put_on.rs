//! How garments are put on: as their patterns say, and the other way, for one that fell off the body.

use crate::outfit::DraftedPart;
use std::sync::Arc;
use toile_assembly::PlacementBody;
use toile_pattern::{BodyPart, Draft, Facing, Worn};

/// How garments are put on a body.
pub(crate) struct PutOn {
    /// The garments as they are to be placed.
    pub parts: Arc<Vec<DraftedPart>>,
    /// Whether what would hang from the waist hangs from the chest.
    pub hangs_from_chest: bool,
}

impl PutOn {
    /// As the patterns say.
    pub fn as_given(parts: Arc<Vec<DraftedPart>>) -> Self {
        Self {
            parts,
            hangs_from_chest: false,
        }
    }

    /// The other way round, with words for the first way and for this one.
    pub fn otherwise(parts: &[DraftedPart]) -> (Self, [&'static str; 2]) {
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
            return (otherwise, words);
        }
        if any(is_over) {
            let otherwise = changed(|worn| {
                if let Worn::Wrapped { facing, level, .. } = worn
                    && *facing == Facing::Over
                {
                    (*facing, *level) = (Facing::Around, None);
                }
            });
            return (otherwise, ["over the head", "round the trunk"]);
        }
        if any(has_level) {
            let otherwise = changed(|worn| {
                if let Worn::Wrapped { level, .. } = worn {
                    *level = None;
                }
            });
            let words = ["at the level given", "at the level its kind hangs from"];
            return (otherwise, words);
        }
        let otherwise = Self {
            parts: Arc::new(parts.to_vec()),
            hangs_from_chest: true,
        };
        (otherwise, ["from the waist", "from the chest"])
    }

    /// The body with the levels that garments are hung at.
    pub fn body<'a>(&self, mut body: PlacementBody<'a>) -> PlacementBody<'a> {
        if self.hangs_from_chest {
            body.levels.waist = body.levels.chest;
        }
        body
    }
}

fn is_over(worn: &Worn) -> bool {
    matches!(worn, Worn::Wrapped { facing, .. } if *facing == Facing::Over)
}

/// Whether a piece on the trunk or the legs is told its level.
fn has_level(worn: &Worn) -> bool {
    matches!(worn, Worn::Wrapped { part, level, .. }
        if level.is_some() && !matches!(part, BodyPart::LeftArm | BodyPart::RightArm))
}
