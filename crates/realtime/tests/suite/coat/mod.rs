//! A dog from a file written by hand, and a coat for it.

use toile_realtime::{Character, CharacterFile};

const DOG: &str = include_str!("../../dog.character.json");

/// The dog.
pub fn dog() -> Character {
    let file: CharacterFile = serde_json::from_str(DOG).unwrap();
    file.into_character().unwrap()
}

/// A coat: a tube round the trunk, open below and clear of the legs, `cells` round it and along it.
pub fn coat(cells: u32) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let mut positions = Vec::new();
    for i in 0..=cells {
        for j in 0..=cells {
            let along = -0.22 + 0.44 * i as f32 / cells as f32;
            let angle = 0.55 * std::f32::consts::PI * (2.0 * j as f32 / cells as f32 - 1.0);
            let (sine, cosine) = angle.sin_cos();
            positions.push([0.15 * sine, 0.5 + 0.16 * cosine, along]);
        }
    }
    let mut triangles = Vec::new();
    for i in 0..cells {
        for j in 0..cells {
            let a = i * (cells + 1) + j;
            let (b, c, d) = (a + 1, a + cells + 1, a + cells + 2);
            triangles.extend([[a, c, b], [b, c, d]]);
        }
    }
    (positions, triangles)
}
