//! Command line arguments of `toile-ui --figure`.

use std::ffi::OsString;
use std::path::PathBuf;
use toile_session::{Figure, RealtimeKey, figure_named};

/// A figure to show in clothes.
#[derive(Clone, Debug, PartialEq)]
pub struct FigureTask {
    /// The figure.
    pub figure: Figure,
    /// The patterns it is dressed in, the innermost first.
    pub patterns: Vec<PathBuf>,
    /// Keys to press, each with the number of frames computed after it; and the file for the pictures taken
    /// after each of them, side by side. `None`: a window is opened, and no picture is written.
    pub pictures: Option<(Vec<(RealtimeKey, usize)>, PathBuf)>,
}

/// Largest total number of frames after the keys: a quarter of an hour.
const MAX_FRAMES: usize = 54_000;

/// Largest number of pictures side by side.
const MAX_KEYS: usize = 16;

impl FigureTask {
    /// Reads `--figure NAME [--keys LIST --png FILE] PATTERN…`; `None` if `--figure` is not among the
    /// arguments.
    ///
    /// # Errors
    /// A message on a missing or unknown argument, with the remedy.
    pub fn read(arguments: impl Iterator<Item = OsString>) -> Result<Option<Self>, String> {
        let arguments: Vec<OsString> = arguments.collect();
        if arguments.iter().all(|argument| argument != "--figure") {
            return Ok(None);
        }
        let (mut figure, mut keys, mut png) = (None, None, None);
        let mut patterns = Vec::new();
        let mut rest = arguments.into_iter();
        while let Some(argument) = rest.next() {
            let mut value = |of: &str| {
                let value = rest.next();
                value.ok_or_else(|| format!("{of}: nothing follows it; give its value"))
            };
            match argument.to_string_lossy().as_ref() {
                "--figure" => figure = Some(value("--figure")?),
                "--keys" => keys = Some(value("--keys")?),
                "--png" => png = Some(value("--png")?),
                word if word.starts_with("--") => {
                    return Err(format!(
                        "{word} is not known; give --figure NAME, --keys LIST, --png FILE and patterns"
                    ));
                }
                _ => patterns.push(PathBuf::from(argument)),
            }
        }
        let name = figure.unwrap_or_default().to_string_lossy().into_owned();
        let figure = figure_named(&name)
            .ok_or_else(|| format!("--figure: there is no figure {name:?}; give woman or man"))?;
        if patterns.is_empty() {
            return Err(
                "no pattern to dress the figure in; name one, as in --figure woman t-shirt.toile.json"
                    .to_owned(),
            );
        }
        let pictures = match (keys, png) {
            (Some(keys), Some(png)) => {
                Some((read_keys(&keys.to_string_lossy())?, PathBuf::from(png)))
            }
            (None, None) => None,
            _ => {
                return Err(
                    "--keys and --png go together: keys, and the file their pictures go into"
                        .to_owned(),
                );
            }
        };
        Ok(Some(Self {
            figure,
            patterns,
            pictures,
        }))
    }
}

/// Reads keys, each followed by a number of frames of a sixtieth of a second, as in "up 90 right 60 g
/// 30".
fn read_keys(list: &str) -> Result<Vec<(RealtimeKey, usize)>, String> {
    let remedy = "write each key with the frames after it, as in \"up 90 right 60 g 30\"";
    let words: Vec<&str> = list.split_whitespace().collect();
    let mut keys = Vec::new();
    for pair in words.chunks(2) {
        let key = RealtimeKey::named(pair[0]).ok_or_else(|| {
            let known = RealtimeKey::ALL.map(|(name, _)| name).join(", ");
            format!(
                "--keys: there is no key {:?} among {known}; {remedy}",
                pair[0]
            )
        })?;
        let frames = pair.get(1).and_then(|word| word.parse().ok());
        let frames = frames
            .ok_or_else(|| format!("--keys: no frames stand after {:?}; {remedy}", pair[0]))?;
        keys.push((key, frames));
    }
    let whole = keys
        .iter()
        .map(|(_, frames)| *frames)
        .fold(0, usize::saturating_add);
    match (keys.len(), whole) {
        (1..=MAX_KEYS, 0..=MAX_FRAMES) => Ok(keys),
        (count, whole) => Err(format!(
            "--keys: {count} keys and {whole} frames; give 1 to {MAX_KEYS} keys and at most {MAX_FRAMES} frames"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(words: &str) -> Result<Option<FigureTask>, String> {
        FigureTask::read(words.split(',').map(OsString::from))
    }

    #[test]
    fn a_figure_its_patterns_and_keys_are_read() {
        assert_eq!(read("a.toile.json"), Ok(None));
        let task = read("--figure,woman,a,b,--keys,up 90 g 5,--png,x.png");
        let task = task.unwrap().unwrap();
        assert_eq!(task.figure, Figure::Woman);
        assert_eq!(task.patterns, ["a", "b"].map(PathBuf::from));
        let keys = vec![(RealtimeKey::Walk, 90), (RealtimeKey::Switch, 5)];
        assert_eq!(task.pictures, Some((keys, PathBuf::from("x.png"))));
    }

    #[test]
    fn what_is_wrong_is_named_with_its_remedy() {
        for (words, part) in [
            ("--figure", "nothing follows"),
            ("--figure,giant,a", "give woman or man"),
            ("--figure,woman", "no pattern"),
            ("--figure,woman,a,--keys,up 9", "go together"),
            ("--figure,woman,a,--png,x,--keys,hop 9", "no key \"hop\""),
            ("--figure,woman,a,--png,x,--keys,up", "no frames"),
            ("--figure,woman,a,--png,x,--keys,", "0 keys"),
            ("--figure,woman,a,--png,x,--keys,up 99999999", "at most"),
            ("--figure,woman,a,--fast", "is not known"),
        ] {
            let refused = read(words).unwrap_err();
            assert!(refused.contains(part), "{words}: {refused}");
        }
    }
}
