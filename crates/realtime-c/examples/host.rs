//! The host of `host/host.c` in Rust: the same dog, blanket and keys, the same output.
#![allow(clippy::print_stdout)]

use std::error::Error;
use toile_realtime::{CharacterFile, Ellipsoids, Garment, GarmentSettings};

const CELLS: u32 = 16;
const SIDE: u32 = CELLS + 1;
const FRAME: f32 = 1.0 / 60.0;

/// Key and the frame it is pressed in.
const KEYS: [(u32, char); 6] = [
    (60, 'w'),
    (300, 'g'),
    (450, 's'),
    (520, 'g'),
    (600, 'w'),
    (900, 's'),
];

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("give a character file")?;
    let file: CharacterFile = serde_json::from_str(&std::fs::read_to_string(path)?)?;
    let mut dog = Ellipsoids::new(&file.into_character()?)?;
    let at = |k: u32| -0.2 + 0.025 * k as f32;
    let positions: Vec<[f32; 3]> = (0..SIDE)
        .flat_map(|i| (0..SIDE).map(move |j| [at(i), 0.66, at(j)]))
        .collect();
    let triangles: Vec<[u32; 3]> = (0..CELLS)
        .flat_map(|i| (0..CELLS).map(move |j| i * SIDE + j))
        .flat_map(|a| [[a, a + 1, a + SIDE], [a + 1, a + SIDE + 1, a + SIDE]])
        .collect();
    let settings = GarmentSettings {
        offset: 0.005,
        ..GarmentSettings::default()
    };
    let mut blanket = Garment::new(&dog, &positions, &triangles, settings)?;
    dog.start("stand", 0.0)?;
    let mut hangs = true;
    for frame in 0..1000 {
        for (_, key) in KEYS.iter().filter(|(pressed, _)| *pressed == frame) {
            match key {
                'g' => hangs = !hangs,
                'w' => dog.start("trot", 0.3)?,
                _ => dog.start("stand", 0.3)?,
            }
        }
        dog.advance(FRAME);
        match hangs {
            true => blanket.adjust_by_gravity(&dog, FRAME),
            false => blanket.adjust_by_shape(&dog, FRAME),
        }
    }
    for number in blanket.positions().flatten() {
        println!("{:08x}", number.to_bits());
    }
    Ok(())
}
