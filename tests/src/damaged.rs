//! Damaged pattern files of every format: each is a pattern, or an error with its place and a remedy, and soon.

use crate::random::Random;
use std::sync::OnceLock;
use std::time::Instant;
use toile_interchange::{
    Companion, Fitting, Format, ReadOptions, SizedDraft, WriteSource, read, write,
};
use toile_pattern::fields::Choice;
use toile_session::{Command, SAMPLES, Session, Silent};

/// Files of one run.
pub const FILES: usize = 100;
/// Most changes of one file.
const MAX_CHANGES: usize = 8;
/// Longest stretch that is cut out or put in again (bytes).
const MAX_STRETCH: usize = 200;
/// Time that reading a damaged file may take (s).
const MAX_SECONDS: f64 = 2.0;
/// What is put in place of numbers and words.
const NONSENSE: [&str; 12] = [
    "nan",
    "1e308",
    "-1e308",
    "1e-320",
    "-0",
    "99999999999999999999",
    "",
    "\"",
    "<",
    "{",
    "\u{0}",
    "M 0 0 C",
];
/// A pattern of Valentina with points, a spline, an increment and a piece.
const VALENTINA: &str = r##"<?xml version="1.0" encoding="UTF-8"?><pattern><version>0.9.0</version><unit>cm</unit>
<measurements/><increments><increment name="#ease" formula="waist_circ/20+2" description=""/></increments>
<draw name="block"><calculation>
<point id="1" type="single" name="A" x="0" y="0" mx="0" my="0"/>
<point id="2" type="endLine" name="B" basePoint="1" angle="0" length="waist_circ/4+#ease" mx="0" my="0"/>
<point id="3" type="endLine" name="C" basePoint="2" angle="270" length="40" mx="0" my="0"/>
<point id="4" type="pointOfIntersection" name="D" firstPoint="1" secondPoint="3" mx="0" my="0"/>
<spline id="5" type="simpleInteractive" point1="3" point4="4" angle1="160" angle2="20" length1="5" length2="Line_A_B/4"/>
</calculation><modeling>
<point id="11" idObject="1" type="modeling"/><point id="12" idObject="2" type="modeling"/>
<point id="13" idObject="3" type="modeling"/><point id="14" idObject="4" type="modeling"/>
<spline id="15" idObject="5" type="modelingSpline"/>
</modeling><details><detail id="20" name="front" mx="0" my="0" width="1" seamAllowance="true" version="2">
<nodes><node idObject="11" type="NodePoint"/><node idObject="12" type="NodePoint"/><node idObject="13" type="NodePoint"/>
<node idObject="15" type="NodeSpline"/><node idObject="14" type="NodePoint"/></nodes></detail></details></draw></pattern>"##;
/// A grade rule table.
const RULES: &str = "ANSI/AAMA-292\nUNITS: METRIC\nGRADE RULE TABLE: T\nNUMBER OF SIZES: 3\nSIZE LIST: S M L\nSAMPLE SIZE: M\n\
                     RULE: DELTA 1\n0,0 0,0 0,0\nRULE: DELTA 2\n-1.5,2 0,0 1.5,-2\nEND\n";

/// A file of a format, sound.
fn sound(format: Format) -> Result<Vec<u8>, String> {
    match format {
        Format::Valentina => return Ok(VALENTINA.as_bytes().to_vec()),
        Format::Seamly => {
            let text = VALENTINA
                .replace("<details>", "<pieces>")
                .replace("</details>", "</pieces>");
            let text = text
                .replace("<detail ", "<piece ")
                .replace("</detail>", "</piece>");
            return Ok(text.into_bytes());
        }
        Format::Native | Format::GarmentCode | Format::Svg | Format::DxfAama | Format::DxfAstm => {}
    }
    let mut session = Session::new();
    let poncho = SAMPLES.iter().find(|(_, name)| *name == "Poncho");
    let (path, _) = poncho.ok_or("there is no poncho")?;
    let open = session.execute(Command::open(*path), &mut Silent);
    open.map_err(|error| error.to_string())?;
    let pattern = session.project().pattern.clone();
    let draft = SizedDraft {
        size: None,
        draft: (*session.draft()).clone(),
    };
    let source = WriteSource {
        pattern: &pattern,
        fitting: &Fitting::default(),
        drafts: &[draft],
    };
    let writing = write(&source, format).map_err(|error| error.to_string())?;
    let first = writing.files.into_iter().next();
    Ok(first.ok_or("nothing was written")?.bytes)
}

/// A file of each format.
type Files = Vec<(Format, Vec<u8>)>;

/// Sound files of all formats.
fn all_sound() -> Result<&'static [(Format, Vec<u8>)], String> {
    static FILES: OnceLock<Result<Files, String>> = OnceLock::new();
    let made = FILES.get_or_init(|| {
        let all = Format::all().iter();
        all.map(|&format| Ok((format, sound(format)?))).collect()
    });
    made.as_deref().map_err(Clone::clone)
}

/// Changes a file in a place.
fn change(bytes: &mut Vec<u8>, random: &mut Random) {
    let at = random.below(bytes.len());
    let end = (at + 1 + random.below(MAX_STRETCH)).min(bytes.len());
    match random.below(6) {
        0 => bytes[at] = random.below(256) as u8,
        1 => {
            bytes.drain(at..end);
        }
        2 => {
            let again = bytes[at..end].to_vec();
            let to = random.below(bytes.len());
            bytes.splice(to..to, again);
        }
        3 => bytes.truncate(at),
        _ => {
            // A number or word becomes another.
            let is_word = |byte: &u8| byte.is_ascii_alphanumeric() || matches!(byte, b'.' | b'-');
            let start = at + bytes[at..].iter().position(is_word).unwrap_or(0);
            let stop = bytes[start.min(bytes.len())..]
                .iter()
                .position(|byte| !is_word(byte));
            let stop = (start + stop.unwrap_or(0)).min(bytes.len());
            let word = random.one_of(&NONSENSE).copied().unwrap_or_default();
            bytes.splice(start.min(stop)..stop, word.bytes());
        }
    }
}

/// Reads [`FILES`] damaged files by a seed; `is_timed` holds each to its time.
///
/// # Errors
/// What does not hold, with the format, the seed and the number of the file.
pub fn damaged(seed: u64, is_timed: bool) -> Result<(), String> {
    let files = all_sound()?;
    let mut random = Random(seed.wrapping_mul(0x9e37_79b9));
    for k in 0..FILES {
        let Some((format, sound)) = random.one_of(files) else {
            continue;
        };
        let told = |what: String| format!("{}, seed {seed}, file {k}: {what}", format.word());
        let mut bytes = sound.clone();
        for _ in 0..=random.below(MAX_CHANGES) {
            if !bytes.is_empty() {
                change(&mut bytes, &mut random);
            }
        }
        let mut companions = Vec::new();
        if matches!(format, Format::DxfAama | Format::DxfAstm) && random.percent(30) {
            let mut table = RULES.as_bytes().to_vec();
            change(&mut table, &mut random);
            companions.push(Companion {
                name: "t.rul".to_owned(),
                bytes: table,
            });
        }
        let options = ReadOptions {
            format: random.percent(50).then_some(*format),
            ..ReadOptions::default()
        };
        let start = Instant::now();
        let answer = std::panic::catch_unwind(|| read(&bytes, &options, &companions));
        let seconds = start.elapsed().as_secs_f64();
        match answer {
            Err(_) => return Err(told("the reader panics".to_owned())),
            Ok(Err(error)) if error.place.is_empty() || error.hint.is_empty() => {
                return Err(told(format!("refused without place or remedy: {error}")));
            }
            Ok(_) => {}
        }
        if is_timed && seconds > MAX_SECONDS {
            return Err(told(format!("it takes {seconds:.1} s")));
        }
    }
    Ok(())
}
