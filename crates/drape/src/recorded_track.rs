//! The track of recorded positions: straight from frame to frame, still before the first and after the last.

use crate::DrapeError;
use crate::digest::Digest;
use crate::track::Track;
use toile_geometry::Vec3;

/// Positions of the vertices of a surface at ascending times.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedTrack {
    times: Vec<f64>,
    frames: Vec<Vec<Vec3>>,
    digest: u64,
}

impl RecordedTrack {
    /// The track through frames: their times (s) with the positions of all vertices (m).
    ///
    /// # Errors
    /// No frame, times that do not ascend, frames of different lengths, a number that is not finite.
    pub fn new(frames: Vec<(f64, Vec<Vec3>)>) -> Result<Self, DrapeError> {
        let (times, frames): (Vec<f64>, Vec<Vec<Vec3>>) = frames.into_iter().unzip();
        let refuse = |frame: usize, what: String| {
            Err(DrapeError::Scene {
                place: format!("frame {frame}"),
                what,
                remedy: "record the frames again".to_owned(),
            })
        };
        let Some(count) = frames.first().map(Vec::len) else {
            return refuse(0, "there is none".to_owned());
        };
        for (k, (time, frame)) in times.iter().zip(&frames).enumerate() {
            if frame.len() != count {
                let what = format!("it has {} vertices, the first has {count}", frame.len());
                return refuse(k, what);
            }
            if !(time.is_finite() && frame.iter().flatten().all(|x| x.is_finite())) {
                return refuse(k, "a number in it is not finite".to_owned());
            }
            if k > 0 && *time <= times[k - 1] {
                return refuse(
                    k,
                    format!("its time, {time} s, is not after the one before"),
                );
            }
        }
        let mut digest = Digest::new();
        digest.numbers(&times);
        for frame in &frames {
            digest.vectors(frame);
        }
        Ok(Self {
            digest: digest.value(),
            times,
            frames,
        })
    }
}

impl Track for RecordedTrack {
    fn positions(&self, time: f64) -> Vec<Vec3> {
        let next = self.times.partition_point(|&known| known <= time);
        let Some(before) = next.checked_sub(1) else {
            return self.frames[0].clone();
        };
        if next == self.times.len() {
            return self.frames[before].clone();
        }
        let share = (time - self.times[before]) / (self.times[next] - self.times[before]);
        let pairs = self.frames[before].iter().zip(&self.frames[next]);
        pairs.map(|(a, b)| a + (b - a) * share).collect()
    }

    fn digest(&self) -> u64 {
        self.digest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_met_to_the_bit_and_joined_by_straight_lines() {
        let at = |x: f64| vec![Vec3::new(x, 1.0 / 3.0, 0.0)];
        let frames = vec![(0.1, at(0.1)), (0.3, at(0.7)), (0.4, at(-2.0))];
        let track = RecordedTrack::new(frames.clone()).unwrap();
        for (time, positions) in &frames {
            assert_eq!(track.positions(*time), *positions);
        }
        assert!((track.positions(0.2)[0].x - 0.4).abs() < 1e-15);
        assert_eq!(track.positions(-1.0), at(0.1));
        assert_eq!(track.positions(9.0), at(-2.0));
        let mut other = frames.clone();
        other[1].1[0].x = 0.7_f64.next_up();
        assert_ne!(RecordedTrack::new(other).unwrap().digest(), track.digest());
        for wrong in [
            Vec::new(),
            vec![(0.0, at(0.0)), (0.0, at(1.0))],
            vec![(0.0, at(0.0)), (1.0, Vec::new())],
            vec![(0.0, at(f64::NAN))],
            vec![(f64::INFINITY, at(0.0))],
        ] {
            assert!(RecordedTrack::new(wrong).is_err());
        }
    }
}
