//! Columns of a hand's rings that run along the grooves between closed fingers.

use std::f64::consts::{PI, TAU};

/// Angle about the middle of the hand from the centre line of the back or of the palm to the outer grooves
/// between fingers (rad).
const GROOVE: f64 = 44.0 * PI / 180.0;
/// Columns from one groove to the next.
const COLUMNS: usize = 3;

/// Even angles, moved by a share (0 to 1) of the way to other angles, at which every third column near the
/// centre lines of back and palm lies in a groove between fingers. The centre line of the back is at angle 0,
/// that of the palm at half a turn.
pub(crate) fn gathered(even: &[f64], share: f64) -> Vec<f64> {
    let n = even.len();
    if share <= 0.0 || n < 6 * COLUMNS {
        return even.to_vec();
    }
    let step = TAU / n as f64;
    let off = |angle: f64| angle.sin().atan2(angle.cos());
    let middle = (0..n)
        .min_by(|&a, &b| off(even[a]).abs().total_cmp(&off(even[b]).abs()))
        .unwrap_or_default();
    let half = n / 2;
    let knots = [
        (0, 0.0),
        (COLUMNS, GROOVE),
        (half - COLUMNS, PI - GROOVE),
        (half, PI),
        (half + COLUMNS, PI + GROOVE),
        (n - COLUMNS, TAU - GROOVE),
        (n, TAU),
    ];
    let angle = |column: usize| {
        let k = knots.partition_point(|knot| knot.0 <= column).min(6);
        let ((low, from), (high, to)) = (knots[k - 1], knots[k]);
        from + (to - from) * (column - low) as f64 / (high - low) as f64
    };
    let shift = off(even[middle]);
    (0..n)
        .map(|k| {
            let column = (k + n - middle) % n;
            even[k] + share * (angle(column) - step * column as f64 - shift)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_lie_in_the_grooves_and_keep_their_order() {
        for n in [32, 34, 36] {
            let even: Vec<f64> = (0..n).map(|k| 1.3 + TAU * k as f64 / n as f64).collect();
            assert_eq!(gathered(&even, 0.0), even);
            let angles = gathered(&even, 1.0);
            for groove in [0.0, GROOVE, PI - GROOVE, PI, PI + GROOVE, TAU - GROOVE] {
                let near = |a: &f64| ((a - groove).cos() - 1.0).abs() < 1e-12;
                assert_eq!(angles.iter().filter(|a| near(a)).count(), 1, "{n} {groove}");
            }
            assert!(angles.windows(2).all(|w| w[0] < w[1]), "{angles:?}");
            assert!(angles[n - 1] - angles[0] < TAU);
        }
    }
}
