//! Small pictures of garments as they last hung, for the cards of the first page: kept in the user's
//! folder, one for each of the recent files.

use super::ToileApp;
use super::job::Job;
use egui::ColorImage;
use std::fs;
use std::path::{Path, PathBuf};

/// Name of the folder of the pictures.
const FOLDER: &str = "drapes";
/// Width and height of a picture (pixels).
const SIZE: [usize; 2] = [240, 360];

/// Path of the picture for a pattern file, named by a digest of the file's path (FNV-1a; Fowler, Noll, Vo
/// 1991).
pub fn place(folder: &Path, file: &Path) -> PathBuf {
    let path = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
    let bytes = path.as_os_str().as_encoded_bytes();
    let digest = bytes
        .iter()
        .fold(0xCBF2_9CE4_8422_2325, |digest: u64, byte| {
            (digest ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01B3)
        });
    folder.join(FOLDER).join(format!("{digest:016x}.png"))
}

/// Reads a picture; `None` if there is no picture or it cannot be read.
pub fn read(place: &Path) -> Option<ColorImage> {
    let file = std::io::BufReader::new(fs::File::open(place).ok()?);
    let mut reader = png::Decoder::new(file).read_info().ok()?;
    let mut bytes = vec![0; reader.output_buffer_size()?];
    let frame = reader.next_frame(&mut bytes).ok()?;
    let size = [frame.width as usize, frame.height as usize];
    let bytes = bytes.get(..frame.buffer_size())?;
    match (frame.color_type, frame.bit_depth) {
        (png::ColorType::Rgb, png::BitDepth::Eight) => Some(ColorImage::from_rgb(size, bytes)),
        (png::ColorType::Rgba, png::BitDepth::Eight) => {
            Some(ColorImage::from_rgba_unmultiplied(size, bytes))
        }
        _ => None,
    }
}

impl ToileApp {
    /// Saves a picture of the garment that has just come to rest, if its pattern is saved in a file. A
    /// failure is not reported: only the card on the first page lacks the picture then.
    pub(super) fn keep_drape_view(&mut self) {
        if self.is_unsaved()
            || self
                .drape_view
                .as_ref()
                .is_some_and(|job| job.result().is_none())
        {
            return;
        }
        let Some(folder) = self.preferences.folder() else {
            return;
        };
        let source = self.session.project().source.as_deref();
        let Some(source) = source.filter(|source| source.exists()) else {
            return;
        };
        let picture = place(folder, source);
        let recent = self.preferences.recent.iter();
        let recent = recent.map(|file| place(folder, file));
        let known: Vec<PathBuf> = recent.chain([picture.clone()]).collect();
        let mut snapshot = self.session.snapshot();
        self.drape_view = Some(Job::start(move |_| {
            if let Some(parent) = picture.parent() {
                forget_others(parent, &known);
                let _ = fs::create_dir_all(parent);
            }
            snapshot.write_drape_view(&picture, SIZE)
        }));
    }
}

/// Removes the pictures of files that are no longer among the recent ones.
fn forget_others(folder: &Path, known: &[PathBuf]) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    for path in entries.flatten().map(|entry| entry.path()) {
        let is_picture = path.extension().is_some_and(|ending| ending == "png");
        if is_picture && !known.contains(&path) {
            let _ = fs::remove_file(path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_has_a_place_of_its_own_and_rubbish_is_no_picture() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| place(folder.path(), Path::new(name));
        assert_eq!(at("/a/dress.toile.json"), at("/a/dress.toile.json"));
        assert_ne!(at("/a/dress.toile.json"), at("/b/dress.toile.json"));
        let rubbish = folder.path().join("rubbish.png");
        assert!(read(&rubbish).is_none());
        fs::write(&rubbish, b"\x89PNG\r\n\x1a\nrubbish").unwrap();
        assert!(read(&rubbish).is_none());
        forget_others(folder.path(), &[]);
        assert!(!rubbish.exists());
    }
}
