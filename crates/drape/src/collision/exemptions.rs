//! Pairs of features that are exempt from contact and from impacts. Contact forces would lock a crossing in place;
//! between exempt features the recovery forces of [`Recovery`](super::Recovery) can undo it.
//!
//! # Decided with
//! - [`crate::pair_policies::PairPolicies`]: objects that pass through each other;
//! - [`crate::collision::entanglement`]: tangles, whose pairs are let through;
//! - [`crate::contact_settings::ContactSettings`]: no contact of cloth at all where the cloth offset is 0;
//! - [`crate::garment::GarmentSetup::sewing_environment`]: none while a garment is sewn;
//! - [`crate::method::MethodKind::supports`] (`features.rs`): methods that know no contact of cloth.

use super::entanglement::Entanglement;
use super::feature_pair::FeaturePair;
use super::layer_order::layer_order;
use super::surface::ClothSurface;
use crate::{Model, PairPolicies};
use std::cmp::Ordering;
use std::sync::Arc;

/// Exempt pairs of features, given by marks on their vertices. Each detection makes them; contact, impact resolution
/// and step truncation use them until the next one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactExemptions {
    /// Vertices of an edge and a face that cross within one layer, or between vertices of no layer.
    pub crossed: Vec<bool>,
    /// Vertices of an edge and a face of two layers that cross, and vertices on the wrong side of a layer.
    pub disordered: Vec<bool>,
    /// Vertices within a few rings of edges of a crossing that persists; empty where no crossing persists.
    pub loosened: Vec<bool>,
    /// Persistence of the crossing at each vertex: up by one in a detection that finds the vertex at a crossing, down
    /// by one but not below zero in any other; empty where all are zero.
    pub crossing_counts: Vec<u32>,
    /// Layer of each vertex; empty where all are of one.
    pub layer: Arc<Vec<u16>>,
    /// Objects that ignore each other: their pairs are exempt from contact and from impacts.
    pub policies: Arc<PairPolicies>,
}

/// Whether any vertex of a feature is marked.
fn any(marks: &[bool], feature: &[u32]) -> bool {
    (feature.iter()).any(|&v| marks.get(v as usize).is_some_and(|&mark| mark))
}

impl ContactExemptions {
    /// Whether two features may pass through each other. Within one layer: both have a vertex marked `crossed`, or
    /// both one marked `loosened`. Between layers: either has a `disordered` vertex. Always: their objects ignore
    /// each other.
    pub fn exempts_impact(&self, pair: FeaturePair) -> bool {
        let vertices = pair.vertices();
        let (first, second) = vertices.split_at(pair.first());
        if self.policies.ignores(first, second) {
            return true;
        }
        if layer_order(&self.layer, first[0], second[0]) == Ordering::Equal {
            let both = |marks| any(marks, first) && any(marks, second);
            both(&self.crossed) || both(&self.loosened)
        } else {
            any(&self.disordered, &vertices)
        }
    }

    /// Whether two features make no contact: the pairs of [`Self::exempts_impact`], and within one layer also pairs
    /// with a `crossed` vertex in only one of the two features.
    pub fn exempts_contact(&self, pair: FeaturePair) -> bool {
        let vertices = pair.vertices();
        let ordered = layer_order(&self.layer, vertices[0], vertices[pair.first()]);
        let marks = match ordered {
            Ordering::Equal => &self.crossed,
            _ => &self.disordered,
        };
        let (first, second) = vertices.split_at(pair.first());
        if self.policies.ignores(first, second) {
            return true;
        }
        let both_loosened =
            ordered == Ordering::Equal && any(&self.loosened, first) && any(&self.loosened, second);
        any(marks, &vertices) || both_loosened
    }

    /// Clears all marks and takes over the layers and the pair policies of a model.
    pub(super) fn reset(&mut self, model: &Model) {
        let count = model.vertex_count();
        for marks in [&mut self.crossed, &mut self.disordered] {
            marks.clear();
            marks.resize(count, false);
        }
        self.loosened.clear();
        self.crossing_counts.clear();
        self.layer.clone_from(&model.layer);
        self.policies.clone_from(&model.policies);
    }

    /// Marks the vertices of an entanglement, and those round crossings that persist. `crossing_counts` has the counts
    /// of the last detection.
    pub(super) fn mark(
        &mut self,
        surface: &ClothSurface,
        entangled: &Entanglement,
        crossing_counts: &[u32],
    ) {
        let marks = [
            (&entangled.within, &mut self.crossed),
            (&entangled.of_layers, &mut self.disordered),
        ];
        for (crossings, marks) in marks {
            for &[e, t] in crossings {
                let face = surface.triangles[t as usize];
                for v in surface.edges[e as usize].into_iter().chain(face) {
                    marks[v as usize] = true;
                }
            }
        }
        for violation in &entangled.violations {
            self.disordered[violation.vertex as usize] = true;
        }
        self.crossing_counts = updated_counts(&self.crossed, crossing_counts);
        self.loosened = loosened_round(&surface.edges, &self.crossed, &self.crossing_counts);
    }
}

/// The persistence counts after a detection: plus one at crossed vertices, minus one elsewhere; empty where all are
/// zero.
fn updated_counts(crossed: &[bool], before: &[u32]) -> Vec<u32> {
    if before.is_empty() && !crossed.contains(&true) {
        return Vec::new();
    }
    let before = before.iter().copied().chain(std::iter::repeat(0));
    let counts = crossed.iter().zip(before);
    let counts = counts.map(|(&crossed, before)| match crossed {
        true => before + 1,
        false => before.saturating_sub(1),
    });
    let counts: Vec<u32> = counts.collect();
    match counts.iter().any(|&count| count > 0) {
        true => counts,
        false => Vec::new(),
    }
}

/// Persistence, in detections, after which another ring of vertices round a crossing is loosened: measured with
/// the planted tangles of the soak test.
const DETECTIONS_PER_RING: u32 = 25;

/// Most rings of vertices loosened round a crossing: contact farther off does not hold it.
const MAX_RINGS: u32 = 8;

/// Vertices within some rings of edges of a persistent crossing, one ring more for every [`DETECTIONS_PER_RING`] of
/// its count: the contacts of cloth on the wrong side round a crossing would lock the crossing. Empty where no
/// crossing persists.
fn loosened_round(edges: &[[u32; 2]], crossed: &[bool], crossing_counts: &[u32]) -> Vec<bool> {
    let rings = crossed.iter().zip(crossing_counts);
    let rings = rings.map(|(&crossed, count)| u32::from(crossed) * count / DETECTIONS_PER_RING);
    let mut rings: Vec<u32> = rings.map(|rings| rings.min(MAX_RINGS)).collect();
    let widest = rings.iter().copied().max().unwrap_or(0);
    if widest == 0 {
        return Vec::new();
    }
    let mut loosened: Vec<bool> = rings.iter().map(|&rings| rings > 0).collect();
    for _ in 0..widest {
        let before = rings.clone();
        for &[a, b] in edges {
            for [a, b] in [[a as usize, b as usize], [b as usize, a as usize]] {
                if before[a] > rings[b] {
                    rings[b] = before[a] - 1;
                    loosened[b] = true;
                }
            }
        }
    }
    loosened
}

#[cfg(test)]
mod tests {
    use super::super::layer_order::BETWEEN_LAYERS;
    use super::*;

    #[test]
    fn cloth_is_loosened_ring_by_ring_round_a_crossing_that_persists() {
        // A row of vertices, the first of which is at a crossing.
        let edges: Vec<[u32; 2]> = (0..12).map(|v| [v, v + 1]).collect();
        let crossed: Vec<bool> = (0..13).map(|v| v == 0).collect();
        let mut counts = Vec::new();
        for detection in 1..=400 {
            counts = updated_counts(&crossed, &counts);
            let loosened = loosened_round(&edges, &crossed, &counts);
            let rings = (detection / DETECTIONS_PER_RING).min(MAX_RINGS) as usize;
            match rings {
                0 => assert!(loosened.is_empty()),
                _ => assert!(
                    (0..13).all(|v| loosened[v] == (v <= rings)),
                    "{detection}: {loosened:?}"
                ),
            }
        }
        let none = [false; 13];
        assert!(
            loosened_round(&edges, &none, &counts).is_empty(),
            "only round crossings of this detection"
        );
        for _ in 0..399 {
            counts = updated_counts(&none, &counts);
        }
        assert_eq!(counts[0], 1);
        assert!(updated_counts(&none, &counts).is_empty());
        assert!(updated_counts(&none, &[]).is_empty());
    }

    #[test]
    fn pairs_are_exempt_by_their_layers_and_marks() {
        let layer = Arc::new(vec![0, 1, BETWEEN_LAYERS]);
        let pair = FeaturePair::EdgeEdge([0, 0, 1, 1]);
        let both = |exemptions: &ContactExemptions| {
            [
                exemptions.exempts_impact(pair),
                exemptions.exempts_contact(pair),
            ]
        };
        let disordered = ContactExemptions {
            crossed: vec![true; 3],
            disordered: vec![false, true, false],
            layer,
            ..ContactExemptions::default()
        };
        assert_eq!(both(&disordered), [true; 2]);
        let ordered = ContactExemptions {
            disordered: vec![false; 3],
            ..disordered
        };
        assert_eq!(
            both(&ordered),
            [false; 2],
            "a crossing within another layer"
        );
        let same = ContactExemptions {
            layer: Arc::default(),
            ..ordered
        };
        assert_eq!(both(&same), [true; 2]);
        let one = ContactExemptions {
            crossed: vec![true, false, false],
            ..same
        };
        assert_eq!(both(&one), [false, true], "one of the two at a crossing");
        // Both features need a loosened vertex.
        for (loosened, exempt) in [([true, true, false], true), ([true, false, true], false)] {
            let round = ContactExemptions {
                loosened: loosened.to_vec(),
                ..ContactExemptions::default()
            };
            assert_eq!(both(&round), [exempt; 2]);
        }
    }
}
