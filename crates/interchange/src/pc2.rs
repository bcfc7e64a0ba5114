//! Point caches (PC2): positions of a mesh's vertices at equal steps, as Blender's mesh cache reads them.
//!
//! Little-endian: the 12 bytes `POINTCACHE2` and a zero, then version, number of points, first frame, frames
//! per sample, number of samples, then the positions in `f32`.

use crate::FormatError;

/// Positions of the same points at equal time steps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointCache {
    /// Frame of the first sample.
    pub start: f32,
    /// Number of frames from one sample to the next.
    pub step: f32,
    /// The samples: positions in the unit of the mesh.
    pub samples: Vec<Vec<[f32; 3]>>,
}

const SIGNATURE: &[u8; 12] = b"POINTCACHE2\0";
const VERSION: u32 = 1;
const REMEDY: &str = "write the point cache (PC2) again";

/// Writes a point cache.
///
/// # Errors
/// Samples of different lengths, a coordinate that is not finite, or more points than the format can count.
pub fn write_pc2(cache: &PointCache) -> Result<Vec<u8>, FormatError> {
    let points = cache.samples.first().map_or(0, Vec::len);
    let refuse = |what: String| FormatError::new("the point cache", what, "record it again");
    let count = |number: usize| {
        u32::try_from(number).map_err(|_| refuse(format!("{number} is more than it can count")))
    };
    let mut bytes = Vec::with_capacity(32 + 12 * points * cache.samples.len());
    bytes.extend(SIGNATURE);
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend(count(points)?.to_le_bytes());
    bytes.extend(cache.start.to_le_bytes());
    bytes.extend(cache.step.to_le_bytes());
    bytes.extend(count(cache.samples.len())?.to_le_bytes());
    for (number, sample) in cache.samples.iter().enumerate() {
        if sample.len() != points {
            return Err(refuse(format!(
                "sample {number} has {} points, the first has {points}",
                sample.len()
            )));
        }
        check_sample(number, sample)?;
        bytes.extend(sample.iter().flatten().flat_map(|x| x.to_le_bytes()));
    }
    Ok(bytes)
}

fn check_sample(number: usize, sample: &[[f32; 3]]) -> Result<(), FormatError> {
    match sample.iter().flatten().all(|x| x.is_finite()) {
        true => Ok(()),
        false => Err(FormatError::new(
            format!("sample {number}"),
            "a coordinate is not finite",
            REMEDY,
        )),
    }
}

/// Reads a point cache.
///
/// # Errors
/// Bytes that are no point cache, are cut short, or have a coordinate that is not finite: the place.
pub fn read_pc2(bytes: &[u8]) -> Result<PointCache, FormatError> {
    let refuse = |what: &str| FormatError::new("the point cache", what, REMEDY);
    let body = bytes.strip_prefix(SIGNATURE);
    let body = body.ok_or_else(|| refuse("it is no PC2 file"))?;
    let (fields, body) = body
        .split_first_chunk::<20>()
        .ok_or_else(|| refuse("it ends within its head"))?;
    let (fields, _) = fields.as_chunks::<4>();
    let integer = |k: usize| u32::from_le_bytes(fields[k]);
    if integer(0) != VERSION {
        return Err(refuse(&format!("version {} is not known", integer(0))));
    }
    let (points, samples) = (integer(1) as usize, integer(4) as usize);
    let (start, step) = (f32::from_le_bytes(fields[2]), f32::from_le_bytes(fields[3]));
    if !(start.is_finite() && step.is_finite() && step > 0.0) {
        return Err(refuse("its first frame or its step is out of range"));
    }
    let length = 12_usize.checked_mul(points).filter(|&length| length > 0);
    let length = length.ok_or_else(|| refuse("it has no points"))?;
    if length.checked_mul(samples) != Some(body.len()) {
        return Err(refuse(&format!(
            "{} bytes are not those of {samples} samples of {points} points",
            body.len()
        )));
    }
    let read = |sample: &[u8]| -> Vec<[f32; 3]> {
        let (numbers, _) = sample.as_chunks::<4>();
        let (positions, _) = numbers.as_chunks::<3>();
        positions
            .iter()
            .map(|p| p.map(f32::from_le_bytes))
            .collect()
    };
    let samples: Vec<Vec<[f32; 3]>> = body.chunks_exact(length).map(read).collect();
    for (number, sample) in samples.iter().enumerate() {
        check_sample(number, sample)?;
    }
    match samples.is_empty() {
        true => Err(refuse("it has no samples")),
        false => Ok(PointCache {
            start,
            step,
            samples,
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_cache_is_laid_out_as_published_and_read_to_the_bit() {
        let cache = PointCache {
            start: 1.0,
            step: 0.5,
            samples: vec![vec![[0.1, 0.2, 0.3], [1.0, -0.0, 2.0]], vec![[4.0; 3]; 2]],
        };
        let bytes = write_pc2(&cache).unwrap();
        assert_eq!(&bytes[..12], b"POINTCACHE2\0");
        assert_eq!(bytes[12..20], [1, 0, 0, 0, 2, 0, 0, 0]);
        assert_eq!(bytes[28..32], [2, 0, 0, 0]);
        assert_eq!(bytes[32..36], 0.1_f32.to_le_bytes());
        assert_eq!(bytes.len(), 32 + 2 * 2 * 12);
        assert_eq!(read_pc2(&bytes).unwrap(), cache);
        for cut in 0..bytes.len() {
            assert!(read_pc2(&bytes[..cut]).is_err(), "{cut}");
        }
        let mut wild = bytes.clone();
        wild[32..36].copy_from_slice(&f32::NAN.to_le_bytes());
        assert!(read_pc2(&wild).unwrap_err().what.contains("not finite"));
        let mut uneven = cache;
        uneven.samples[1].pop();
        assert!(write_pc2(&uneven).is_err());
    }
}
