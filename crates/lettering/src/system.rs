//! Which font has a letter: those that the program brings first, then those of the system.

use crate::font::{Font, file_covers};
use fontdb::{Database, FaceInfo, ID, Stretch, Style};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

/// The fonts that the program brings, in the order in which they are asked.
static BROUGHT: LazyLock<Vec<Arc<Font>>> = LazyLock::new(|| {
    let files = [
        epaint_default_fonts::UBUNTU_LIGHT,
        epaint_default_fonts::NOTO_EMOJI_REGULAR,
    ];
    let fonts = files.iter().map(|file| Font::new(Cow::Borrowed(*file), 0));
    fonts.flatten().map(Arc::new).collect()
});

/// The fonts of the system, best first. They are looked for when a letter is met that the
/// program's own fonts lack.
static SYSTEM: LazyLock<System> = LazyLock::new(System::new);

struct System {
    fonts: Database,
    order: Vec<ID>,
    opened: Mutex<Opened>,
}

/// What was found out about the fonts of the system.
#[derive(Default)]
struct Opened {
    fonts: BTreeMap<usize, Option<Arc<Font>>>,
    by_letter: BTreeMap<String, Option<usize>>,
}

/// The font that draws boxes in place of letters that none has.
pub(crate) fn fallback() -> Option<Arc<Font>> {
    BROUGHT.first().cloned()
}

/// The first font that has all of some letters that belong together.
pub(crate) fn font_for(letters: &str) -> Option<Arc<Font>> {
    let brought = BROUGHT.iter().find(|font| font.has(letters));
    brought.cloned().or_else(|| SYSTEM.font_for(letters))
}

impl System {
    fn new() -> Self {
        let mut fonts = Database::new();
        fonts.load_system_fonts();
        let mut ranked: Vec<_> = fonts.faces().map(|face| (rank(face), face.id)).collect();
        ranked.sort_by(|a, b| a.0.cmp(&b.0));
        Self {
            order: ranked.into_iter().map(|(_, id)| id).collect(),
            fonts,
            opened: Mutex::default(),
        }
    }

    fn font_for(&self, letters: &str) -> Option<Arc<Font>> {
        let mut opened = self.opened.lock().unwrap_or_else(PoisonError::into_inner);
        let found = match opened.by_letter.get(letters) {
            Some(found) => *found,
            None => {
                let covers = |id: &ID| {
                    let reads = |data: &[u8], index| file_covers(data, index, letters);
                    self.fonts.with_face_data(*id, reads).unwrap_or(false)
                };
                let found = self.order.iter().position(covers);
                opened.by_letter.insert(letters.to_owned(), found);
                found
            }
        };
        let place = found?;
        let open = || {
            let whole = |data: &[u8], index| Font::new(Cow::Owned(data.to_vec()), index);
            let font = self
                .fonts
                .with_face_data(self.order[place], whole)
                .flatten();
            font.map(Arc::new)
        };
        opened.fonts.entry(place).or_insert_with(open).clone()
    }
}

/// The lower the better: upright, of usual weight and width, without serifs; then by name, so that
/// the choice does not hang on the order in which files are found.
fn rank(face: &FaceInfo) -> (bool, u16, bool, bool, u8, String, String, String, u32) {
    let family = face.families.first().map_or("", |(name, _)| name);
    let kind = match family {
        name if name.starts_with("Noto Sans") => 0,
        name if name.starts_with("DejaVu Sans") => 1,
        name if name.contains("Sans") => 2,
        name if name.contains("Unifont") || name.contains("LastResort") => 5,
        name if name.contains("Serif") => 4,
        _ => 3,
    };
    let path = match &face.source {
        fontdb::Source::File(path) | fontdb::Source::SharedFile(path, _) => {
            path.to_string_lossy().into_owned()
        }
        fontdb::Source::Binary(_) => String::new(),
    };
    (
        face.style != Style::Normal,
        face.weight.0.abs_diff(400),
        face.stretch != Stretch::Normal,
        face.monospaced,
        kind,
        family.to_owned(),
        face.post_script_name.clone(),
        path,
        face.index,
    )
}
