//! Colours of a picture reduced to a palette: median cut (Heckbert 1982).

use std::collections::HashMap;

/// Most colours of a palette.
const MOST: usize = 256;

type Colour = [u8; 3];

/// Colours with how often each is there.
type Bin = Vec<(Colour, usize)>;

/// A palette of at most 256 colours, and the number in it of every pixel.
pub fn reduced(pixels: &[Colour]) -> (Vec<Colour>, Vec<u8>) {
    let mut counts: HashMap<Colour, usize> = HashMap::new();
    for pixel in pixels {
        *counts.entry(*pixel).or_default() += 1;
    }
    let mut all: Bin = counts.into_iter().collect();
    all.sort_unstable();
    let mut boxes = vec![all];
    // The box with the widest channel, weighed by its pixels, is halved until there are enough.
    while boxes.len() < MOST {
        let widest = (0..boxes.len()).max_by_key(|k| weight(&boxes[*k])).unwrap();
        let (channel, width) = widest_channel(&boxes[widest]);
        if width == 0 {
            break;
        }
        let mut low = boxes.swap_remove(widest);
        low.sort_by_key(|(colour, _)| colour[channel]);
        let half = low.iter().map(|(_, count)| count).sum::<usize>() / 2;
        let mut passed = 0;
        let middle = low.iter().position(|(_, count)| {
            passed += count;
            passed > half
        });
        let middle = middle.unwrap_or(0).clamp(1, low.len() - 1);
        let high = low.split_off(middle);
        boxes.extend([low, high]);
    }
    let mut numbers: HashMap<Colour, u8> = HashMap::new();
    let mut palette = Vec::new();
    for (number, inside) in boxes.iter().enumerate() {
        palette.push(mean(inside));
        numbers.extend(inside.iter().map(|(colour, _)| (*colour, number as u8)));
    }
    let indices = pixels.iter().map(|pixel| numbers[pixel]).collect();
    (palette, indices)
}

/// The channel that differs most in a box, and by how much.
fn widest_channel(colours: &Bin) -> (usize, u8) {
    let widths = (0..3).map(|channel| {
        let values = colours.iter().map(|(colour, _)| colour[channel]);
        let (least, most) = (values.clone().min(), values.max());
        (channel, most.unwrap() - least.unwrap())
    });
    widths.max_by_key(|(_, width)| *width).unwrap()
}

/// How much is won by halving a box: the width of its widest channel counts more than its pixels, or
/// flat grounds would take the palette.
fn weight(colours: &Bin) -> u64 {
    let pixels: usize = colours.iter().map(|(_, count)| count).sum();
    let width = u64::from(widest_channel(colours).1);
    width * width * (1 + pixels as u64).ilog2() as u64
}

fn mean(colours: &Bin) -> Colour {
    let pixels: usize = colours.iter().map(|(_, count)| count).sum();
    [0, 1, 2].map(|channel| {
        let sum = colours
            .iter()
            .map(|(colour, count)| usize::from(colour[channel]) * count);
        ((sum.sum::<usize>() + pixels / 2) / pixels) as u8
    })
}
