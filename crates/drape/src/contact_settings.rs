//! How cloth meets surfaces and cloth: distances kept, stiffness, friction.

use crate::{DrapeError, Material};

/// How far outside a surface its distance field reaches [m].
pub(crate) const FIELD_REACH: f64 = 0.03;

/// The most that the samples of a triangle which goes on crossing a surface are kept farther off
/// [m]: what is still found then is not cured by distance.
pub(crate) const MOST_EXTRA: f64 = 8e-3;

/// The most that cloth can be kept from a surface [m]: what its distance field reaches, less what a
/// triangle that goes on crossing is kept farther off.
pub const MOST_OFFSET: f64 = FIELD_REACH - MOST_EXTRA;

/// How cloth meets solid surfaces and other cloth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSettings {
    /// Distance kept between the middle of the cloth and a surface [m], at most [`MOST_OFFSET`]; half
    /// the cloth's thickness where that is more ([`Self::for_cloth`]). It must exceed the sagitta of an
    /// edge on the tightest curve of the body: e^2 / (8 R).
    pub offset: f64,
    /// Normal stiffness per area of cloth [N/m3]: pressure per depth.
    pub stiffness: f64,
    /// Whether friction acts.
    pub friction: bool,
    /// Distance kept between the middles of two cloths [m], the cloth's thickness where that is more; 0
    /// lets cloth pass through cloth.
    pub cloth_offset: f64,
}

impl Default for ContactSettings {
    /// 4 mm: over the 3.1 mm sagitta of a 20 mm edge on a wrist of 16 mm radius.
    /// 1e6 N/m3: 100 Pa (a close fit) sinks 0.1 mm. Cloth passes through cloth.
    fn default() -> Self {
        Self {
            offset: 4e-3,
            stiffness: 1e6,
            friction: true,
            cloth_offset: 0.0,
        }
    }
}

impl ContactSettings {
    /// The same for cloth of some materials: it keeps at least half of the thickest one's thickness
    /// from surfaces and, where cloth is kept from cloth, all of it from cloth.
    #[must_use]
    pub fn for_cloth<'a>(self, materials: impl IntoIterator<Item = &'a Material>) -> Self {
        let each = materials.into_iter().map(|material| material.thickness);
        let thickness = each.fold(0.0, f64::max);
        let apart = self.cloth_offset > 0.0;
        Self {
            offset: self.offset.max(0.5 * thickness),
            cloth_offset: match apart {
                true => self.cloth_offset.max(thickness),
                false => 0.0,
            },
            ..self
        }
    }

    /// Checks that surfaces are felt as far off as cloth is to be kept from them.
    ///
    /// # Errors
    /// Refuses an offset beyond [`MOST_OFFSET`], at the place given.
    pub(crate) fn check_reach(&self, place: &str) -> Result<(), DrapeError> {
        if self.offset <= MOST_OFFSET {
            return Ok(());
        }
        Err(DrapeError::Scene {
            place: place.to_owned(),
            what: format!(
                "the middle of the cloth would keep {} m from surfaces; they are felt to {MOST_OFFSET} m at most",
                self.offset
            ),
            remedy: format!(
                "give a collision.offset of at most {MOST_OFFSET} and cloth at most {} m thick",
                2.0 * MOST_OFFSET
            ),
        })
    }
}
