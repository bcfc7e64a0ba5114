//! Pairs of features that are exempt from contact and from impacts. Contact would hold cloth that has
//! crossed where it is; where features are exempt, the pulls of [`Recovery`](super::Recovery) can draw
//! it apart.

use super::entanglement::Entanglement;
use super::feature_pair::FeaturePair;
use super::layer_order::layer_order;
use super::surface::ClothSurface;
use crate::{Model, PairPolicies};
use std::cmp::Ordering;
use std::sync::Arc;

/// Exempt pairs of features, told by their vertices: a value that a detection makes and hands to all that
/// follows it, until the next one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactExemptions {
    /// Vertices at a crossing of cloth that is in no order of layers.
    pub crossed: Vec<bool>,
    /// Vertices at a crossing of two layers, or on the wrong side of one.
    pub disordered: Vec<bool>,
    /// Vertices round a crossing that persists; empty where none does.
    pub loosened: Vec<bool>,
    /// A count for each vertex, up by one in a detection that finds it at a crossing and down by one, not below
    /// zero, in any other; empty where all are zero.
    pub crossed_for: Vec<u32>,
    /// Layer of each vertex; empty where all are of one.
    pub layer: Arc<Vec<u16>>,
    /// Objects that ignore each other: their pairs are exempt from both.
    pub policies: Arc<PairPolicies>,
}

/// Whether any vertex of a feature is marked.
fn any(marks: &[bool], feature: &[u32]) -> bool {
    (feature.iter()).any(|&v| marks.get(v as usize).is_some_and(|&mark| mark))
}

impl ContactExemptions {
    /// Whether two features may pass through each other: in one layer where both have a vertex at a
    /// crossing or both one round a crossing that persists, between layers where either has a
    /// disordered vertex; and where their objects ignore each other.
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

    /// Whether two features make no contact: those of [`Self::exempts_impact`], and in one layer also
    /// those of which only one has a vertex at a crossing.
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
        let loose =
            ordered == Ordering::Equal && any(&self.loosened, first) && any(&self.loosened, second);
        any(marks, &vertices) || loose
    }

    /// Exempts nothing but what the policies of a model say.
    pub(super) fn reset(&mut self, model: &Model) {
        let count = model.vertex_count();
        for marks in [&mut self.crossed, &mut self.disordered] {
            marks.clear();
            marks.resize(count, false);
        }
        self.loosened.clear();
        self.crossed_for.clear();
        self.layer.clone_from(&model.layer);
        self.policies.clone_from(&model.policies);
    }

    /// Exempts what is entangled, and, round crossings that persist, what lies about them. `crossed_for`
    /// is what the last detection remembered.
    pub(super) fn mark(
        &mut self,
        surface: &ClothSurface,
        entangled: &Entanglement,
        crossed_for: &[u32],
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
        self.crossed_for = counted(&self.crossed, crossed_for);
        self.loosened = loosened_round(&surface.edges, &self.crossed, &self.crossed_for);
    }
}

/// For how many detections vertices have been at a crossing, each without subtracted; empty where none
/// was.
fn counted(crossed: &[bool], before: &[u32]) -> Vec<u32> {
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

/// Detections after which the cloth is loosened by one ring of edges more round a vertex that stays at a
/// crossing, and the most rings.
const WIDER_AFTER: u32 = 25;
const WIDEST: u32 = 8;

/// Vertices round those that stay at a crossing, one ring of edges more after every [`WIDER_AFTER`]
/// detections: where cloth lies on the wrong side round a crossing, its contacts hold it there. Empty where
/// none stays.
fn loosened_round(edges: &[[u32; 2]], crossed: &[bool], crossed_for: &[u32]) -> Vec<bool> {
    let rings = crossed.iter().zip(crossed_for);
    let rings = rings.map(|(&crossed, count)| u32::from(crossed) * count / WIDER_AFTER);
    let mut rings: Vec<u32> = rings.map(|rings| rings.min(WIDEST)).collect();
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
        for look in 1..=400 {
            counts = counted(&crossed, &counts);
            let loosened = loosened_round(&edges, &crossed, &counts);
            let rings = (look / WIDER_AFTER).min(WIDEST) as usize;
            match rings {
                0 => assert!(loosened.is_empty()),
                _ => assert!(
                    (0..13).all(|v| loosened[v] == (v <= rings)),
                    "{look}: {loosened:?}"
                ),
            }
        }
        let none = [false; 13];
        assert!(
            loosened_round(&edges, &none, &counts).is_empty(),
            "not where none is"
        );
        for _ in 0..399 {
            counts = counted(&none, &counts);
        }
        assert_eq!(counts[0], 1);
        assert!(counted(&none, &counts).is_empty());
        assert!(counted(&none, &[]).is_empty());
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
        // Round a crossing both have to be loosened.
        for (loosened, exempt) in [([true, true, false], true), ([true, false, true], false)] {
            let round = ContactExemptions {
                loosened: loosened.to_vec(),
                ..ContactExemptions::default()
            };
            assert_eq!(both(&round), [exempt; 2]);
        }
    }
}
