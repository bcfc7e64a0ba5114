//! Colour maps: equal steps of the value are equal steps to the eye.

use crate::colour::{Rgb, linear_from_oklab, srgb_from_linear};
use std::sync::LazyLock;

/// Which colours stand for the values from 0 to 1. All of them keep their order for people who
/// see no difference between red and green, and in grey print (the diverging one by side).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColourMap {
    /// Dark violet through teal to light yellow.
    Depth,
    /// Nearly white through yellow and orange to dark red: for what should stay low.
    Heat,
    /// Blue through white to red: for signed values, 0.5 is neutral.
    Signed,
}

/// Lightness, chroma and hue (degree) in OKLab of the points a map runs through.
type Stops = &'static [[f64; 3]];

const DEPTH: Stops = &[
    [0.28, 0.115, 305.0],
    [0.40, 0.115, 275.0],
    [0.52, 0.090, 230.0],
    [0.64, 0.100, 180.0],
    [0.78, 0.155, 140.0],
    [0.93, 0.180, 106.0],
];
const HEAT: Stops = &[
    [0.95, 0.020, 100.0],
    [0.88, 0.105, 92.0],
    [0.76, 0.145, 68.0],
    [0.62, 0.170, 42.0],
    [0.46, 0.155, 25.0],
    [0.32, 0.110, 10.0],
];
const SIGNED: Stops = &[
    [0.40, 0.145, 262.0],
    [0.58, 0.130, 255.0],
    [0.78, 0.075, 248.0],
    [0.97, 0.000, 0.0],
    [0.78, 0.075, 38.0],
    [0.58, 0.150, 30.0],
    [0.40, 0.145, 26.0],
];

/// Entries of a table; between them colours are mixed.
const ENTRIES: usize = 256;

static TABLES: LazyLock<[Vec<Rgb>; 3]> = LazyLock::new(|| [DEPTH, HEAT, SIGNED].map(table));

impl ColourMap {
    /// The colour of a value from 0 to 1; values outside get the end colours, what is not a
    /// number gets grey.
    pub fn colour(self, value: f64) -> Rgb {
        if value.is_nan() {
            return [0.5; 3];
        }
        let table = &TABLES[self as usize];
        let place = value.clamp(0.0, 1.0) * (ENTRIES - 1) as f64;
        let below = (place as usize).min(ENTRIES - 2);
        crate::colour::mix(table[below], table[below + 1], place - below as f64)
    }
}

/// Colours at equal distances along the path through the stops, distance as in OKLab.
fn table(stops: Stops) -> Vec<Rgb> {
    let stops: Vec<[f64; 3]> = stops
        .iter()
        .map(|&[lightness, chroma, hue]| {
            let (sine, cosine) = hue.to_radians().sin_cos();
            [lightness, chroma * cosine, chroma * sine]
        })
        .collect();
    let fine = 64 * (stops.len() - 1);
    let path: Vec<[f64; 3]> = (0..=fine).map(|k| along(&stops, k as f64 / 64.0)).collect();
    let mut lengths = vec![0.0];
    for pair in path.windows(2) {
        let step: f64 = (0..3).map(|k| (pair[1][k] - pair[0][k]).powi(2)).sum();
        lengths.push(lengths[lengths.len() - 1] + step.sqrt());
    }
    let total = lengths[fine];
    let mut k = 0;
    (0..ENTRIES)
        .map(|entry| {
            let wanted = total * entry as f64 / (ENTRIES - 1) as f64;
            while k + 2 < lengths.len() && lengths[k + 1] < wanted {
                k += 1;
            }
            let part = (wanted - lengths[k]) / (lengths[k + 1] - lengths[k]);
            srgb_from_linear(linear_from_oklab(crate::colour::mix(
                path[k],
                path[k + 1],
                part,
            )))
        })
        .collect()
}

/// A smooth path through all stops (Catmull and Rom 1974); `place` counts stops.
fn along(stops: &[[f64; 3]], place: f64) -> [f64; 3] {
    let last = stops.len() - 1;
    let i = (place as usize).min(last - 1);
    let t = place - i as f64;
    let at = |k: isize| stops[k.clamp(0, last as isize) as usize];
    let [p0, p1, p2, p3] = [-1, 0, 1, 2].map(|k| at(i as isize + k));
    [0, 1, 2].map(|k| {
        let slope_1 = 0.5 * (p2[k] - p0[k]);
        let slope_2 = 0.5 * (p3[k] - p1[k]);
        let d = p2[k] - p1[k];
        p1[k]
            + t * (slope_1
                + t * (3.0 * d - 2.0 * slope_1 - slope_2 + t * (slope_1 + slope_2 - 2.0 * d)))
    })
}

/// The colours of values: a range over a map, and a separate colour for values above it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColourScale {
    /// The colours.
    pub map: ColourMap,
    /// Value of the first colour, in the field's own unit.
    pub low: f64,
    /// Value of the last colour.
    pub high: f64,
    /// Colour of everything above `high`; the last colour of the map when absent.
    pub over: Option<Rgb>,
}

impl ColourScale {
    /// A colour no map contains, for values over the limit.
    pub const OVER: Rgb = [0.85, 0.0, 0.75];

    /// The colour of a value.
    pub fn colour(&self, value: f64) -> Rgb {
        match self.over {
            Some(over) if value > self.high => over,
            _ => self.map.colour((value - self.low) / (self.high - self.low)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::tests::oklab_from_srgb;

    const MAPS: [ColourMap; 3] = [ColourMap::Depth, ColourMap::Heat, ColourMap::Signed];

    #[test]
    fn steps_look_equal() {
        for map in MAPS {
            let seen: Vec<_> = (0..=64)
                .map(|k| oklab_from_srgb(map.colour(f64::from(k) / 64.0)))
                .collect();
            let steps: Vec<f64> = seen
                .windows(2)
                .map(|p| {
                    (0..3)
                        .map(|k| (p[1][k] - p[0][k]).powi(2))
                        .sum::<f64>()
                        .sqrt()
                })
                .collect();
            let mean = steps.iter().sum::<f64>() / steps.len() as f64;
            for step in steps {
                assert!(
                    (step / mean - 1.0).abs() < 0.25,
                    "{map:?}: {step} against {mean}"
                );
            }
        }
    }

    #[test]
    fn lightness_keeps_the_order() {
        let lightness =
            |map: ColourMap, k: i32| oklab_from_srgb(map.colour(f64::from(k) / 40.0))[0];
        for k in 0..40 {
            assert!(lightness(ColourMap::Depth, k) < lightness(ColourMap::Depth, k + 1));
            assert!(lightness(ColourMap::Heat, k) > lightness(ColourMap::Heat, k + 1));
        }
        for k in 0..20 {
            let (left, right) = (
                lightness(ColourMap::Signed, k),
                lightness(ColourMap::Signed, 40 - k),
            );
            assert!((left - right).abs() < 0.03, "{left} {right}");
        }
        let white = ColourMap::Signed.colour(0.5);
        assert!(white.iter().all(|&c| c > 0.94), "{white:?}");
    }

    #[test]
    fn stops_are_colours_a_screen_can_show() {
        for stops in [DEPTH, HEAT, SIGNED] {
            for &[lightness, chroma, hue] in stops {
                let (sine, cosine) = hue.to_radians().sin_cos();
                let light = linear_from_oklab([lightness, chroma * cosine, chroma * sine]);
                assert!(
                    light.iter().all(|l| (-0.012..=1.012).contains(l)),
                    "{lightness} {chroma} {hue}: {light:?}"
                );
            }
        }
    }

    #[test]
    fn values_outside_and_not_numbers() {
        let map = ColourMap::Depth;
        assert_eq!(map.colour(-3.0), map.colour(0.0));
        assert_eq!(map.colour(f64::INFINITY), map.colour(1.0));
        assert_eq!(map.colour(f64::NAN), [0.5; 3]);
        let scale = ColourScale {
            map,
            low: 0.0,
            high: 5.0,
            over: Some(ColourScale::OVER),
        };
        assert_eq!(scale.colour(5.1), ColourScale::OVER);
        assert_eq!(scale.colour(5.0), map.colour(1.0));
        assert_eq!(scale.colour(2.5), map.colour(0.5));
    }
}
