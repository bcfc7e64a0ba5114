//! Options of cut pieces that the pattern does not give: shrinkage, and cloth for fusing.

/// Shrinkage of a cloth when it is washed, as shares of its length.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shrinkage {
    /// Share lost along the warp, below 1; 0.03 for 3 %.
    pub warp: f64,
    /// Share lost along the weft, below 1.
    pub weft: f64,
}

/// Largest share that cloth may shrink or grow; no measured cloth comes near it.
const MAX_SHRINKAGE: f64 = 0.5;

impl Shrinkage {
    /// Whether both shares are finite and from -0.5 to 0.5.
    pub fn is_sound(&self) -> bool {
        let sound = |share: f64| share.is_finite() && share.abs() <= MAX_SHRINKAGE;
        sound(self.warp) && sound(self.weft)
    }

    /// Factors by which a piece is enlarged along the warp and the weft, so that it has the drafted size
    /// after washing.
    pub fn factors(&self) -> [f64; 2] {
        [self.warp, self.weft].map(|share| 1.0 / (1.0 - share))
    }
}

/// Options of cut pieces that the pattern does not give.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CutOptions {
    /// Shrinkage of the cloth when washed. The seam line is enlarged for it; allowances keep their widths.
    pub shrinkage: Shrinkage,
    /// Width of the extra cloth all round beyond the allowances (m), for pieces that are fused and then cut
    /// again.
    pub block: f64,
}
