//! Darts of a flattened panel.

use toile_geometry::{Vec2, ring_area};

/// A dart of a panel: its legs, from the mouth to the apex, as vertices of the opened surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Dart {
    /// The leg on the left seen from the mouth.
    pub left: Vec<u32>,
    /// The leg on the right.
    pub right: Vec<u32>,
}

impl Dart {
    /// Whether its sides lie over one another on the panel, so that cloth has to be added there (a gusset) and none can be
    /// taken away.
    pub fn overlaps(&self, places: &[Vec2]) -> bool {
        let ring: Vec<Vec2> = (self.left.iter().chain(self.right.iter().rev()))
            .map(|&v| places[v as usize])
            .collect();
        // The opening lies clockwise between the legs.
        ring_area(&ring) > 0.0
    }

    /// Its legs as they are sewn, straight from the mouth to the apex (m).
    pub fn straight_legs(&self, places: &[Vec2]) -> Vec<[Vec2; 2]> {
        let ends = |leg: &[u32]| Some([*leg.first()?, *leg.last()?].map(|v| places[v as usize]));
        [&self.left, &self.right]
            .into_iter()
            .filter_map(|leg| ends(leg))
            .collect()
    }

    /// Distance of the ends of the legs at the mouth on the panel (m).
    pub fn intake(&self, places: &[Vec2]) -> f64 {
        match (self.left.first(), self.right.first()) {
            (Some(&a), Some(&b)) => (places[a as usize] - places[b as usize]).norm(),
            (None, _) | (_, None) => 0.0,
        }
    }
}
