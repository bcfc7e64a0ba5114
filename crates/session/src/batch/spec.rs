//! The specification of a batch, read with the places of its faults.

use super::limits::{Limits, memory_of, time_of};
use super::strict_json::read_strictly;
use super::work::{FILE, Work};
use crate::choice::figure_named;
use crate::open::{is_sample, read_input};
use crate::paths::resolved;
use crate::{SAMPLES, SessionError};
use serde_json::{Map, Value};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use toile_interchange::{ExpectedKind, FormatError};
use toile_pattern::fields::Choice;

/// The format's name in its file.
const FORMAT: &str = "toile-batch";
/// Version of specifications.
const VERSION: u64 = 1;
/// Word for all sizes of each pattern.
const ALL: &str = "all";
/// Word for the fabric or the body that the pattern's file keeps.
const KEPT: &str = "pattern";
/// Most entries of a list.
const MAX_LISTED: usize = 100_000;
/// Fields of a specification.
const FIELDS: [&str; 8] = [
    "format", "version", "patterns", "sizes", "fabrics", "bodies", "do", "options",
];
/// Options of a specification that are no options of commands.
const LIMITS: [&str; 2] = ["time_limit", "memory_limit"];

/// Looks whether the command line takes its arguments, and says why not.
pub type CheckArguments<'a> = &'a dyn Fn(&[String]) -> Result<(), String>;

/// Sizes that are asked for.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum AskedSizes {
    /// The size that a pattern's file keeps, else its base size.
    Kept,
    /// All of each pattern.
    All,
    /// These.
    Named(Vec<String>),
}

/// A pattern, fabric or body: as it is named, and as a command takes it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Named {
    pub word: String,
    /// The name, or the absolute path of the file.
    pub argument: String,
}

/// What a batch does.
#[derive(Clone, Debug)]
pub struct Spec {
    path: PathBuf,
    /// The fields as they are written, but for the limits: two specifications are the same if these are.
    pub(crate) fields: Value,
    pub(crate) patterns: Vec<Named>,
    pub(crate) sizes: AskedSizes,
    /// Fabrics; `None` for the pattern's own.
    pub(crate) fabrics: Vec<Option<Named>>,
    /// Bodies; `None` for the pattern's own.
    pub(crate) bodies: Vec<Option<Named>>,
    pub(crate) works: Vec<Work>,
    pub(crate) options: BTreeMap<Work, BTreeMap<String, Option<String>>>,
    pub(crate) limits: Limits,
}

fn fault(place: impl Into<String>, what: impl Into<String>, hint: &str) -> FormatError {
    FormatError::new(place, what, hint)
}

impl Spec {
    /// Reads a specification; files are found from its folder. `check` looks whether commands take the options.
    ///
    /// # Errors
    /// The file cannot be read, is no specification, or asks for what is not there; with place and remedy.
    pub fn open(path: &Path, check: CheckArguments) -> Result<Self, SessionError> {
        let text = read_input(path, ExpectedKind::SmallJson)?;
        Self::read(&text, path, check).map_err(|error| SessionError::Format {
            path: path.to_owned(),
            error,
        })
    }

    fn read(text: &str, path: &Path, check: CheckArguments) -> Result<Self, FormatError> {
        let value = read_strictly(text)?;
        let Value::Object(fields) = &value else {
            let hint = "write an object with the fields patterns and do";
            return Err(fault("the file", "it is no object", hint));
        };
        known_fields(fields)?;
        let folder = resolved(path.parent().unwrap_or(Path::new("")));
        let patterns = words(fields, "patterns")?.ok_or_else(|| {
            let hint = "name at least one pattern file, as in \"patterns\": [\"shirt.toile.json\"]";
            fault("patterns", "the field is missing", hint)
        })?;
        let patterns = patterns.iter().enumerate();
        let patterns = patterns.map(|(k, word)| pattern(word, &folder, k));
        let patterns: Vec<Named> = patterns.collect::<Result<_, _>>()?;
        let works = works(fields)?;
        let sizes = match (fields.get("sizes"), words(fields, "sizes")?) {
            (Some(Value::String(word)), _) if word == ALL => AskedSizes::All,
            (_, Some(names)) => AskedSizes::Named(names),
            (_, None) => AskedSizes::Kept,
        };
        let fabrics = choices(fields, "fabrics", |word, _| Ok(fabric(word, &folder)))?;
        let bodies = choices(fields, "bodies", |word, k| body(word, &folder, k))?;
        if !works.iter().any(|work| work.takes_body()) {
            for field in ["fabrics", "bodies"] {
                if fields.contains_key(field) {
                    let hint = "add one of them to do, or leave the field out";
                    let what = "only make and drape take it, and neither is done";
                    return Err(fault(field, what, hint));
                }
            }
        }
        let (options, limits) = options(fields, &works, check)?;
        if let AskedSizes::Named(names) = &sizes {
            for (k, name) in names.iter().enumerate() {
                let tried = ["check".into(), "pattern".into(), format!("--size={name}")];
                let hint = "give the name of one size a text";
                check(&tried).map_err(|why| fault(format!("sizes[{k}]"), why, hint))?;
            }
        }
        Ok(Self {
            path: path.to_owned(),
            fields: without_limits(fields),
            patterns,
            sizes,
            fabrics,
            bodies,
            works,
            options,
            limits,
        })
    }

    /// An error at a place of the specification.
    pub(crate) fn refuse(&self, place: String, what: String, hint: &str) -> SessionError {
        SessionError::Format {
            path: self.path.clone(),
            error: fault(place, what, hint),
        }
    }
}

fn known_fields(fields: &Map<String, Value>) -> Result<(), FormatError> {
    if let Some(name) = fields.keys().find(|name| !FIELDS.contains(&&***name)) {
        let hint = format!("the fields are {}", FIELDS.join(", "));
        return Err(fault(name, "a batch has no such field", &hint));
    }
    if let Some(format) = fields.get("format").filter(|format| *format != FORMAT) {
        let what = format!("{format} is no batch");
        return Err(fault(
            "format",
            what,
            "write \"toile-batch\", or leave it out",
        ));
    }
    if let Some(version) = fields
        .get("version")
        .filter(|v| v.as_u64() != Some(VERSION))
    {
        let what = format!("batches of version {version} are not read");
        return Err(fault("version", what, "this program reads version 1"));
    }
    Ok(())
}

/// The texts of a list, no two alike; one text stands for a list of one.
fn words(fields: &Map<String, Value>, field: &str) -> Result<Option<Vec<String>>, FormatError> {
    let hint = "give a list of texts";
    let items = match fields.get(field) {
        None => return Ok(None),
        Some(Value::Array(items)) => &items[..],
        Some(one @ Value::String(_)) => std::slice::from_ref(one),
        Some(other) => return Err(fault(field, format!("{other} is no list"), hint)),
    };
    if items.is_empty() {
        let hint = "name at least one, or leave the field out";
        return Err(fault(field, "the list is empty", hint));
    }
    if items.len() > MAX_LISTED {
        let what = format!("{} entries; at most {MAX_LISTED} are read", items.len());
        return Err(fault(field, what, "divide the batch"));
    }
    let mut known = BTreeSet::new();
    let mut texts = Vec::new();
    for (k, item) in items.iter().enumerate() {
        let place = format!("{field}[{k}]");
        let Some(text) = item.as_str().filter(|text| !text.is_empty()) else {
            return Err(fault(place, format!("{item} is no name"), hint));
        };
        if !known.insert(text) {
            let what = format!("{text:?} is named twice");
            return Err(fault(place, what, "name it once"));
        }
        texts.push(text.to_owned());
    }
    Ok(Some(texts))
}

/// Fabrics or bodies, and the pattern's own where none is named.
fn choices(
    fields: &Map<String, Value>,
    field: &str,
    named: impl Fn(&str, usize) -> Result<Named, FormatError>,
) -> Result<Vec<Option<Named>>, FormatError> {
    let Some(words) = words(fields, field)? else {
        return Ok(vec![None]);
    };
    let each = words.iter().enumerate();
    let each = each.map(|(k, word)| match word == KEPT {
        true => Ok(None),
        false => named(word, k).map(Some),
    });
    each.collect()
}

fn works(fields: &Map<String, Value>) -> Result<Vec<Work>, FormatError> {
    let hint = format!("choose from {}", Work::words().join(", "));
    let words = words(fields, "do")?.ok_or_else(|| fault("do", "the field is missing", &hint))?;
    let found = words.iter().enumerate().map(|(k, word)| {
        let found = Work::all().iter().find(|work| work.word() == word);
        found.copied().ok_or_else(|| {
            let what = format!("{word:?} is nothing that a batch does");
            fault(format!("do[{k}]"), what, &hint)
        })
    });
    found.collect()
}

fn pattern(word: &str, folder: &Path, k: usize) -> Result<Named, FormatError> {
    let place = format!("patterns[{k}]");
    if is_sample(Path::new(word)) {
        return Ok(Named {
            word: word.to_owned(),
            argument: word.to_owned(),
        });
    }
    let file = folder.join(word);
    if file.is_file() {
        return utf8(word, &file, place);
    }
    let samples: Vec<&str> = SAMPLES.iter().map(|sample| sample.0).collect();
    let hint = format!(
        "check the spelling; files are found from the folder of the batch's file, and the program brings {}",
        samples.join(", ")
    );
    Err(fault(
        place,
        format!("there is no file {}", file.display()),
        &hint,
    ))
}

fn utf8(word: &str, file: &Path, place: String) -> Result<Named, FormatError> {
    let argument = file.to_str().ok_or_else(|| {
        let what = format!("the path {} is not UTF-8", file.display());
        fault(place, what, "rename the folder")
    })?;
    Ok(Named {
        word: word.to_owned(),
        argument: argument.to_owned(),
    })
}

/// A fabric: a file, else a name, which each pattern is asked for later.
fn fabric(word: &str, folder: &Path) -> Named {
    let file = folder.join(word);
    let argument = file.to_str().filter(|_| file.is_file()).unwrap_or(word);
    Named {
        word: word.to_owned(),
        argument: argument.to_owned(),
    }
}

fn body(word: &str, folder: &Path, k: usize) -> Result<Named, FormatError> {
    let place = format!("bodies[{k}]");
    let (figure, file) = word.split_once(':').unwrap_or((word, ""));
    let (before, file) = match (figure_named(figure), file) {
        (Some(_), "") => {
            return Ok(Named {
                word: word.to_owned(),
                argument: word.to_owned(),
            });
        }
        (Some(_), file) => (format!("{figure}:"), file),
        (None, _) => (String::new(), word),
    };
    let path = folder.join(file);
    if !path.is_file() {
        let what = format!("there is no figure and no file {}", path.display());
        let hint = "give woman, man, mean, dress-form, child-2 to child-14, pattern, a file of measurements, or FIGURE:FILE";
        return Err(fault(place, what, hint));
    }
    let named = utf8(word, &path, place)?;
    Ok(Named {
        argument: format!("{before}{}", named.argument),
        ..named
    })
}

type WorkOptions = BTreeMap<Work, BTreeMap<String, Option<String>>>;

/// Options of the commands that are done, and the limits.
fn options(
    fields: &Map<String, Value>,
    works: &[Work],
    check: CheckArguments,
) -> Result<(WorkOptions, Limits), FormatError> {
    let mut limits = Limits::default();
    let mut found: WorkOptions = works.iter().map(|&work| (work, BTreeMap::new())).collect();
    let given = match fields.get("options") {
        None => return Ok((found, limits)),
        Some(Value::Object(given)) => given,
        Some(other) => {
            let hint = "write an object, as in {\"quality\": \"preview\"}";
            return Err(fault("options", format!("{other} is no object"), hint));
        }
    };
    // Options of one command come before those of all.
    for (name, value) in given.iter().filter(|(_, value)| !value.is_object()) {
        let place = format!("options.{name}");
        let text = value.as_str().unwrap_or_default();
        match &**name {
            "time_limit" => {
                limits.time_s = time_of(text)
                    .map_err(|why| fault(place, why, "write it as text, as in \"10min\""))?;
            }
            "memory_limit" => {
                limits.memory_bytes = memory_of(text)
                    .map_err(|why| fault(place, why, "write it as text, as in \"2GB\""))?;
            }
            _ => {
                let taken = works
                    .iter()
                    .filter(|work| work.options().contains(&&**name));
                let taken: Vec<Work> = taken.copied().collect();
                if taken.is_empty() {
                    return Err(unknown_option(&place, works));
                }
                for work in taken {
                    put(&mut found, work, (name, value), (&place, check))?;
                }
            }
        }
    }
    for (word, own) in given {
        let Value::Object(own) = own else { continue };
        let work = works.iter().find(|work| work.word() == word);
        let work = *work.ok_or_else(|| unknown_option(&format!("options.{word}"), works))?;
        for (name, value) in own {
            let place = format!("options.{word}.{name}");
            if !work.options().contains(&&**name) {
                return Err(unknown_option(&place, &[work]));
            }
            put(&mut found, work, (name, value), (&place, check))?;
        }
    }
    for (work, own) in &found {
        let words = own.iter().filter(|(name, _)| *name != FILE);
        let words = words.map(|(name, value)| argument(name, value.as_deref()));
        let place = format!("options of {}", work.word());
        check(&tried(*work, words.collect()))
            .map_err(|why| fault(place, why, "leave one of them out"))?;
    }
    Ok((found, limits))
}

fn unknown_option(place: &str, works: &[Work]) -> FormatError {
    let mut known: Vec<&str> = LIMITS.to_vec();
    for work in works {
        known.extend(work.options());
    }
    known.sort_unstable();
    known.dedup();
    let hint = format!("what is done here takes {}", known.join(", "));
    fault(place, "nothing that is done takes it", &hint)
}

fn put(
    found: &mut WorkOptions,
    work: Work,
    (name, value): (&str, &Value),
    (place, check): (&str, CheckArguments),
) -> Result<(), FormatError> {
    let hint = "give it as on the command line; `toile COMMAND --help` says how";
    let text = match value {
        Value::Bool(true) => None,
        // As if it had not been given.
        Value::Bool(false) => return Ok(()),
        Value::String(text) => Some(text.clone()),
        Value::Number(number) => Some(number.to_string()),
        Value::Array(items) => {
            let texts = items.iter().map(|item| match item {
                Value::String(text) => Some(text.clone()),
                Value::Number(number) => Some(number.to_string()),
                Value::Null | Value::Bool(_) | Value::Array(_) | Value::Object(_) => None,
            });
            let texts: Option<Vec<String>> = texts.collect();
            let texts =
                texts.ok_or_else(|| fault(place, format!("{value} is no list of words"), hint))?;
            Some(texts.join(","))
        }
        Value::Null | Value::Object(_) => {
            return Err(fault(
                place,
                format!("{value} is no value of an option"),
                hint,
            ));
        }
    };
    match name == FILE {
        true => {
            let file = text.as_deref().unwrap_or_default();
            let name = Path::new(file).file_name().and_then(|name| name.to_str());
            if name != Some(file) {
                let hint = "name a file without its folder, as in \"pieces.svg\"";
                return Err(fault(place, format!("{file:?} is no name of a file"), hint));
            }
        }
        false => check(&tried(work, vec![argument(name, text.as_deref())]))
            .map_err(|why| fault(place, why, hint))?,
    }
    found.entry(work).or_default().insert(name.to_owned(), text);
    Ok(())
}

fn argument(name: &str, value: Option<&str>) -> String {
    match value {
        Some(value) => format!("--{name}={value}"),
        None => format!("--{name}"),
    }
}

/// A command line with the options, to see whether it is taken.
fn tried(work: Work, options: Vec<String>) -> Vec<String> {
    let mut words = vec![work.word().to_owned(), "pattern".to_owned()];
    match (work, work.file()) {
        (Work::Convert, _) => words.push("out".to_owned()),
        (_, Some(_)) => words.push("--out=out".to_owned()),
        (_, None) => {}
    }
    words.extend(options);
    words
}

/// The fields without the limits, which change no result.
fn without_limits(fields: &Map<String, Value>) -> Value {
    let mut fields = fields.clone();
    if let Some(Value::Object(options)) = fields.get_mut("options") {
        options.retain(|name, _| !LIMITS.contains(&&**name));
    }
    fields.into()
}
