//! One job of a batch: what is done with which pattern, its digest, and its file.

use super::limits::Limits;
use super::work::{FILE, Work};
use crate::SessionError;
use crate::digest::digest;
use crate::input::read_file;
use crate::open::{is_sample, read_input};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toile_interchange::{ExpectedKind, FormatError};
use toile_pattern::fields::Choice;

/// The format's name in its file.
const FORMAT: &str = "toile-job";
/// Version of jobs and results; a job of another one has another digest.
const VERSION: u32 = 1;

/// A job of a batch, as its file `job.json` says it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Job {
    format: String,
    version: u32,
    /// Name of the job and of its folder: words and digits of the digest.
    pub id: String,
    /// Digest of what is done, of the files that are read and of the program's version, in hexadecimal digits.
    pub digest: String,
    /// What is done.
    #[serde(rename = "do")]
    pub work: Work,
    /// The pattern as the specification names it.
    named: String,
    /// The pattern's file, or the word of a sample inside the program.
    pub pattern: String,
    /// Named size of the pattern, where one was asked for.
    pub size: Option<String>,
    /// Fabric of the garment: a name, or a file.
    pub fabric: Option<String>,
    /// The body: a figure's name, a file, or both.
    pub body: Option<String>,
    /// Options of the command by name; a flag has no value.
    pub options: BTreeMap<String, Option<String>>,
    /// Further files that are read, for the digest.
    files: Vec<PathBuf>,
    /// Limits of time and memory.
    pub limits: Limits,
}

/// What a specification says of one job.
#[derive(Clone, Debug)]
pub(crate) struct Asked {
    pub work: Work,
    pub named: String,
    pub pattern: String,
    pub size: Option<String>,
    pub fabric: Option<String>,
    pub body: Option<String>,
    pub options: BTreeMap<String, Option<String>>,
    pub files: Vec<PathBuf>,
    pub limits: Limits,
}

/// Digests of files that were read once.
#[derive(Debug, Default)]
pub(crate) struct FileDigests(BTreeMap<PathBuf, String>);

impl FileDigests {
    /// Digest of a file's content; a word where it cannot be read, so that a job waits for no file that is gone.
    fn of(&mut self, path: &Path) -> String {
        let made = || match read_file(path) {
            Ok(bytes) => digest(&bytes),
            Err(_) => "absent".to_owned(),
        };
        self.0.entry(path.to_owned()).or_insert_with(made).clone()
    }
}

impl Job {
    /// The job that was asked for.
    pub(crate) fn new(asked: Asked, digests: &mut FileDigests) -> Self {
        let Asked {
            work,
            named,
            pattern,
            size,
            fabric,
            body,
            options,
            files,
            limits,
        } = asked;
        let mut job = Self {
            format: FORMAT.to_owned(),
            version: VERSION,
            id: String::new(),
            digest: String::new(),
            work,
            named,
            pattern,
            size,
            fabric,
            body,
            options,
            files,
            limits,
        };
        job.digest = job.digest_now(digests);
        job.id = job.id_of(SHORT);
        job
    }

    /// Reads the file of a job.
    ///
    /// # Errors
    /// The file cannot be read or is of no job.
    pub fn open(path: &Path) -> Result<Self, SessionError> {
        let failed = |place: String, what: String| SessionError::Format {
            path: path.to_owned(),
            error: FormatError::new(
                place,
                what,
                "give DIR/jobs/ID/job.json as `toile batch SPEC --out DIR --list` writes it",
            ),
        };
        let job: Self =
            serde_json::from_str(&read_input(path, ExpectedKind::SmallJson)?).map_err(|error| {
                let place = format!("line {}, column {}", error.line(), error.column());
                failed(place, error.to_string())
            })?;
        match (&*job.format, job.version) {
            (FORMAT, VERSION) => Ok(job),
            (FORMAT, other) => Err(failed(
                "version".to_owned(),
                format!(
                    "jobs of version {other} are not read; this program reads version {VERSION}"
                ),
            )),
            (other, _) => Err(failed("format".to_owned(), format!("{other:?} is no job"))),
        }
    }

    /// Refuses a job whose files have changed since it was listed: its result would be one of other files.
    ///
    /// # Errors
    /// The files have changed, or the job was listed by another version of the program.
    pub fn refuse_changed(&self) -> Result<(), SessionError> {
        match self.digest == self.digest_now(&mut FileDigests::default()) {
            true => Ok(()),
            false => Err(SessionError::Conflict(format!(
                "{}: the pattern or a file that it reads has changed since the job was listed, or another version of \
                 the program listed it; list it anew with `toile batch`",
                self.id
            ))),
        }
    }

    /// Digest of what is done, of the files as they are now, and of the program.
    fn digest_now(&self, digests: &mut FileDigests) -> String {
        let mut text = format!("toile {} {VERSION}\n", env!("CARGO_PKG_VERSION"));
        let mut add = |part: &str| text += &format!("{} {part}\n", part.len());
        add(self.work.word());
        add(&self.named);
        for choice in [&self.size, &self.fabric, &self.body] {
            let short = choice.as_deref().map(short_name);
            add(&short.map_or_else(String::new, |short| format!("= {short}")));
        }
        for (name, value) in &self.options {
            add(name);
            add(value.as_deref().unwrap_or_default());
        }
        for file in self.inputs() {
            add(&digests.of(&file));
        }
        digest(text.as_bytes())
    }

    /// The files that the job reads.
    fn inputs(&self) -> Vec<PathBuf> {
        let pattern = Path::new(&self.pattern);
        let own = (!is_sample(pattern)).then(|| pattern.to_owned());
        let chosen = [&self.fabric, &self.body].into_iter().flatten();
        let chosen = chosen.filter_map(|choice| file_of(choice));
        let all = own.into_iter().chain(chosen.map(Path::to_owned));
        all.chain(self.files.iter().cloned()).collect()
    }

    /// Name with a number of digits of the digest.
    fn id_of(&self, digits: usize) -> String {
        let pattern = self.pattern_name();
        let stem = pattern.split('.').next().unwrap_or_default();
        let work = self.work.word().to_owned();
        let choices = [&self.size, &self.fabric, &self.body].into_iter().flatten();
        let choices = choices.map(|choice| short_name(choice));
        let words = [work, stem.to_owned()].into_iter().chain(choices);
        let words: Vec<String> = words.map(|word| crate::output::file_name(&word)).collect();
        let mut words = words.join("-");
        while words.len() > MAX_WORDS {
            words.pop();
        }
        format!("{words}-{}", &self.digest[..digits.min(self.digest.len())])
    }

    /// Gives the job a longer name, if another one has the same.
    pub(crate) fn lengthen_id(&mut self) {
        self.id = self.id_of(self.digest.len());
    }

    /// Name of the pattern's file without its folder.
    pub fn pattern_name(&self) -> String {
        short_name(&self.pattern)
    }

    /// Name of the fabric, or of its file without the folder.
    pub fn fabric_name(&self) -> Option<String> {
        self.fabric.as_deref().map(short_name)
    }

    /// Name of the body, or of its file without the folder.
    pub fn body_name(&self) -> Option<String> {
        self.body.as_deref().map(short_name)
    }

    /// Words of the command line that do the job in the working directory.
    pub fn arguments(&self) -> Vec<String> {
        let mut words = vec![self.work.word().to_owned(), self.pattern.clone()];
        match (self.work, self.work.file()) {
            (_, Some(usual)) => {
                let file = self.options.get(FILE).and_then(Option::as_deref);
                let file = file.unwrap_or(usual);
                words.push(match self.work == Work::Convert {
                    true => file.to_owned(),
                    false => format!("--out={file}"),
                });
            }
            (Work::Check, None) => {}
            (_, None) => words.push("--out=.".to_owned()),
        }
        if self.work == Work::Nest {
            words.push("--threads=1".to_owned());
        }
        let choices = [
            ("size", &self.size),
            ("fabric", &self.fabric),
            ("body", &self.body),
        ];
        for (name, value) in choices {
            words.extend(value.as_ref().map(|value| format!("--{name}={value}")));
        }
        let options = self.options.iter().filter(|(name, _)| *name != FILE);
        words.extend(options.map(|(name, value)| match value {
            Some(value) => format!("--{name}={value}"),
            None => format!("--{name}"),
        }));
        words
    }

    /// A text without the folders of the job's files, so that it is the same wherever they lie.
    pub(crate) fn without_folders(&self, text: &str) -> String {
        let mut text = text.to_owned();
        for file in self.inputs() {
            if let (Some(path), Some(name)) = (file.to_str(), file.file_name()) {
                text = text.replace(path, &name.to_string_lossy());
            }
        }
        text
    }
}

/// Digits of the digest in a job's name.
const SHORT: usize = 8;
/// Longest words of a job's name (bytes), so that names of its parts are names of files on every system.
const MAX_WORDS: usize = 120;

/// The file in a choice such as `FILE` or `FIGURE:FILE`, if it names one.
fn file_of(choice: &str) -> Option<&Path> {
    let whole = Path::new(choice);
    if whole.is_absolute() {
        return Some(whole);
    }
    let (_, after) = choice.split_once(':')?;
    let after = Path::new(after);
    after.is_absolute().then_some(after)
}

/// A choice with its file named without the folder.
fn short_name(choice: &str) -> String {
    match file_of(choice).and_then(|file| Some((file, file.file_name()?))) {
        Some((file, name)) => {
            let file = file.to_string_lossy();
            let before = choice.strip_suffix(&*file).unwrap_or_default();
            format!("{before}{}", name.to_string_lossy())
        }
        None => choice.to_owned(),
    }
}
