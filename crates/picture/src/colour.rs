//! Colours: sRGB as stored, linear light as added, OKLab as seen.

/// A colour in sRGB, each part 0..=1.
pub type Rgb = [f64; 3];

/// Linear light of an sRGB colour (IEC 61966-2-1:1999).
pub(crate) fn linear_from_srgb(colour: Rgb) -> [f64; 3] {
    colour.map(|c| {
        if c <= 0.04045 {
            c / 12.92
        } else {
            ((c + 0.055) / 1.055).powf(2.4)
        }
    })
}

/// sRGB of linear light, clamped to what a screen shows (IEC 61966-2-1:1999).
pub(crate) fn srgb_from_linear(light: [f64; 3]) -> Rgb {
    light.map(|l| {
        let l = l.clamp(0.0, 1.0);
        if l <= 0.003_130_8 {
            12.92 * l
        } else {
            1.055 * l.powf(1.0 / 2.4) - 0.055
        }
    })
}

/// Linear light of an OKLab colour (Ottosson 2020), not clamped.
pub(crate) fn linear_from_oklab([lightness, a, b]: [f64; 3]) -> [f64; 3] {
    let l = (lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b).powi(3);
    let m = (lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b).powi(3);
    let s = (lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b).powi(3);
    [
        4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
        -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
        -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s,
    ]
}

/// Part of the way from one colour to another.
pub(crate) fn mix(from: [f64; 3], to: [f64; 3], part: f64) -> [f64; 3] {
    [0, 1, 2].map(|k| from[k] + (to[k] - from[k]) * part)
}

/// The nearest eight-bit value, by default rounding.
pub(crate) fn byte(value: f64) -> u8 {
    (value.clamp(0.0, 1.0) * 255.0).round() as u8
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// OKLab of an sRGB colour (Ottosson 2020).
    pub(crate) fn oklab_from_srgb(colour: Rgb) -> [f64; 3] {
        let [r, g, b] = linear_from_srgb(colour);
        let l = (0.412_221_470_8 * r + 0.536_332_536_3 * g + 0.051_445_992_9 * b).cbrt();
        let m = (0.211_903_498_2 * r + 0.680_699_545_1 * g + 0.107_396_956_6 * b).cbrt();
        let s = (0.088_302_461_9 * r + 0.281_718_837_6 * g + 0.629_978_700_5 * b).cbrt();
        [
            0.210_454_255_3 * l + 0.793_617_785_0 * m - 0.004_072_046_8 * s,
            1.977_998_495_1 * l - 2.428_592_205_0 * m + 0.450_593_709_9 * s,
            0.025_904_037_1 * l + 0.782_771_766_2 * m - 0.808_675_766_0 * s,
        ]
    }

    #[test]
    fn conversions_are_inverse() {
        for k in 0..=20 {
            let c = f64::from(k) / 20.0;
            let colour = [c, 1.0 - c, 0.3];
            let back = srgb_from_linear(linear_from_srgb(colour));
            let through = srgb_from_linear(linear_from_oklab(oklab_from_srgb(colour)));
            for i in 0..3 {
                assert!((back[i] - colour[i]).abs() < 1e-6);
                assert!((through[i] - colour[i]).abs() < 1e-4);
            }
        }
    }

    #[test]
    fn white_has_lightness_one_and_no_hue() {
        let [lightness, a, b] = oklab_from_srgb([1.0; 3]);
        assert!((lightness - 1.0).abs() < 1e-6 && a.abs() < 1e-6 && b.abs() < 1e-6);
    }
}
