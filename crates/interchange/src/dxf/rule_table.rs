//! Grade rule tables (RUL) of ANSI/AAMA-292 and ASTM D6673, read.
//!
//! Lines `KEY: value` in any order say unit, sizes and sample size; `RULE: DELTA n` begins a rule, whose shifts
//! follow as pairs, one for each size, with blanks or commas between.

use super::text::TextEncoding;
use crate::FormatError;
use std::collections::BTreeMap;
use toile_geometry::Vec2;
use toile_pattern::DisplayUnit;

/// Most bytes of a table.
pub(super) const MAX_TABLE: usize = 16 << 20;
/// Most sizes of a table.
const MAX_SIZES: usize = 200;
/// Most rules of a table.
const MAX_RULES: usize = 100_000;
/// Largest shift (units of the table).
const MAX_SHIFT: f64 = 1e5;

/// A grade rule table.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct RuleTable {
    /// Unit of the shifts, if the table states one.
    pub unit: Option<DisplayUnit>,
    /// Names of the sizes, from small to large.
    pub sizes: Vec<String>,
    /// Index of the sample size.
    pub sample: usize,
    /// Shifts by size against the sample size, by the number of the rule (units of the table).
    pub rules: BTreeMap<u32, Vec<Vec2>>,
}

/// A line of a table: its number from 1, and its text.
type TextLine<'t> = (usize, &'t str);

/// Whether a text is a grade rule table: its first lines name sizes and rules.
pub(crate) fn is_rule_table(text: &str) -> bool {
    let mut has_sizes = false;
    for line in text.lines().take(2000) {
        let Some((key, _)) = pair(line) else {
            continue;
        };
        match key.as_str() {
            "sizelist" | "graderuletable" => has_sizes = true,
            "rule" if has_sizes => return true,
            _ => {}
        }
    }
    false
}

/// Names that the rule table of a DXF may have: that of the drawing, or the one that its style names.
pub(crate) fn rule_table_names(bytes: &[u8], name: &str) -> Vec<String> {
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    let text = String::from_utf8_lossy(bytes);
    let mut values = text.lines().filter_map(pair);
    let named = values.find(|(key, value)| key == "graderuletable" && !value.is_empty());
    let named = named.map(|(_, value)| value.to_owned());
    let stems = std::iter::once(stem.to_owned()).chain(named);
    let stems = stems.map(|stem| match stem.rsplit_once('.') {
        Some((short, ending)) if ending.eq_ignore_ascii_case("rul") => short.to_owned(),
        _ => stem,
    });
    stems
        .flat_map(|stem| ["rul", "RUL", "Rul"].map(|ending| format!("{stem}.{ending}")))
        .collect()
}

/// The key of a line in lower case without blanks, and the value.
fn pair(line: &str) -> Option<(String, &str)> {
    let (key, value) = line.split_once(':')?;
    let key: String = key.to_lowercase().split_whitespace().collect();
    Some((key, value.trim()))
}

fn fault(line: usize, what: impl Into<String>, hint: impl Into<String>) -> FormatError {
    FormatError::new(format!("line {line}"), what, hint)
}

/// Words with blanks or commas between. A list with commas keeps the blanks in its words.
fn words(text: &str) -> Vec<&str> {
    let parts: Vec<&str> = match text.contains(',') {
        true => text.split(',').collect(),
        false => text.split_whitespace().collect(),
    };
    let parts = parts.into_iter().map(str::trim);
    parts.filter(|part| !part.is_empty()).collect()
}

impl RuleTable {
    /// Reads a table.
    ///
    /// # Errors
    /// A line that is none of a table, a rule with too few or too many shifts, no sizes or no sample size among
    /// them: the line, the fault and a remedy.
    pub fn read(bytes: &[u8]) -> Result<Self, FormatError> {
        if bytes.len() > MAX_TABLE {
            return Err(FormatError::new(
                "the whole file",
                format!("it has more than {} MB", MAX_TABLE >> 20),
                "give the grade rule table (RUL) of the pattern",
            ));
        }
        let text = TextEncoding::of_file(bytes, b"").decode(bytes);
        let text = text.trim_start_matches('\u{feff}');
        if !is_rule_table(text) {
            return Err(FormatError::new(
                "the whole file",
                "it is no grade rule table: no SIZE LIST, or no RULE: DELTA after it",
                "give the RUL file that was exported with the DXF",
            ));
        }
        let mut reader = Reader::default();
        for (k, line) in text.lines().enumerate() {
            if !reader.line((k + 1, line.trim()))? {
                break;
            }
        }
        reader.table()
    }
}

/// A table while it is read.
#[derive(Default)]
struct Reader<'t> {
    table: RuleTable,
    /// Number of sizes that the header states.
    count: Option<usize>,
    /// Line of the list of sizes, and the texts in it.
    size_list: Option<(usize, Vec<&'t str>)>,
    /// Whether the line before was of the list of sizes.
    in_list: bool,
    sample: Option<TextLine<'t>>,
    /// The rule whose shifts are read: its line, its number, and the numbers so far.
    open: Option<(usize, u32, Vec<f64>)>,
    /// Rules that are complete, with their lines.
    rules: Vec<(usize, u32, Vec<f64>)>,
}

impl<'t> Reader<'t> {
    /// Takes a line; returns whether the table goes on.
    fn line(&mut self, (number, line): TextLine<'t>) -> Result<bool, FormatError> {
        if line.is_empty() {
            return Ok(true);
        }
        if line.eq_ignore_ascii_case("end") {
            return Ok(false);
        }
        let Some((key, value)) = pair(line) else {
            return self.further((number, line)).map(|()| true);
        };
        self.in_list = false;
        match key.as_str() {
            "units" | "unit" => {
                self.table.unit = match value.to_lowercase().as_str() {
                    "english" | "inch" | "inches" => Some(DisplayUnit::Inch),
                    "metric" | "mm" => Some(DisplayUnit::Millimetre),
                    "cm" => Some(DisplayUnit::Centimetre),
                    "" => None,
                    other => {
                        return Err(fault(
                            number,
                            format!("the unit {other:?} is not known"),
                            "state ENGLISH (inch) or METRIC (millimetre)",
                        ));
                    }
                };
            }
            "numberofsizes" => self.count = value.parse().ok(),
            "sizelist" => {
                self.size_list = Some((number, vec![value]));
                self.in_list = true;
            }
            "samplesize" => self.sample = Some((number, value)),
            "rule" => self.rule(number, value)?,
            // Author, product, dates, name of the table: nothing of them is needed.
            _ => {}
        }
        Ok(true)
    }

    /// Begins a rule.
    fn rule(&mut self, number: usize, value: &str) -> Result<(), FormatError> {
        self.rules.extend(self.open.take());
        if self.rules.len() >= MAX_RULES {
            return Err(fault(
                number,
                format!("there are more than {MAX_RULES} rules"),
                "give the table of one pattern",
            ));
        }
        let mut parts = value.split_whitespace();
        let is_delta = parts
            .next()
            .is_some_and(|word| word.eq_ignore_ascii_case("delta"));
        let last = parts.next_back().map(|word| word.trim_start_matches('#'));
        let own = last.and_then(|word| word.parse::<u32>().ok());
        match own.filter(|_| is_delta) {
            Some(own) => {
                self.open = Some((number, own, Vec::new()));
                Ok(())
            }
            None => Err(fault(
                number,
                format!("{value:?} is no rule of shifts with a number"),
                "write it as RULE: DELTA 7",
            )),
        }
    }

    /// A line without a key: more sizes, shifts, or a title before the rules.
    fn further(&mut self, (number, line): TextLine<'t>) -> Result<(), FormatError> {
        if let Some((_, _, values)) = &mut self.open {
            for word in line.split(|c: char| c == ',' || c.is_whitespace()) {
                if word.is_empty() {
                    continue;
                }
                let value = word.parse::<f64>().ok();
                let value = value.filter(|value| value.abs() <= MAX_SHIFT);
                let value = value.ok_or_else(|| {
                    fault(
                        number,
                        format!("{word:?} is no shift"),
                        format!("give numbers to {MAX_SHIFT} with blanks or commas between"),
                    )
                })?;
                if values.len() >= 2 * MAX_SIZES {
                    return Err(fault(
                        number,
                        format!("the rule has shifts for more than {MAX_SIZES} sizes"),
                        "give one pair for each size",
                    ));
                }
                values.push(value);
            }
        } else if let Some((_, list)) = self.size_list.as_mut().filter(|_| self.in_list) {
            list.push(line);
        }
        Ok(())
    }

    /// The table as read.
    fn table(mut self) -> Result<RuleTable, FormatError> {
        self.rules.extend(self.open.take());
        let mut table = self.table;
        let (line, list) = self.size_list.ok_or_else(|| {
            FormatError::new(
                "the header",
                "it has no list of sizes",
                "add SIZE LIST: and the names from small to large",
            )
        })?;
        let sizes: Vec<&str> = list.iter().flat_map(|text| words(text)).collect();
        let stated = self.count.unwrap_or(sizes.len());
        // Names with blanks may stand between commas, or the other way about.
        let sizes: Vec<&str> = match sizes.len() == stated {
            true => sizes,
            false => {
                let apart = |text: &'t str| {
                    let parts = text.split(|c: char| c == ',' || c.is_whitespace());
                    parts.filter(|part| !part.is_empty())
                };
                list.iter().copied().flat_map(apart).collect()
            }
        };
        if sizes.is_empty() || sizes.len() > MAX_SIZES || sizes.len() != stated {
            return Err(fault(
                line,
                format!(
                    "the list has {} sizes, and NUMBER OF SIZES says {stated}",
                    sizes.len()
                ),
                format!("list each of 1 to {MAX_SIZES} sizes once"),
            ));
        }
        for (k, name) in sizes.iter().enumerate() {
            if sizes[..k].contains(name) {
                return Err(fault(
                    line,
                    format!("size {name:?} stands twice"),
                    "list each size once",
                ));
            }
        }
        table.sizes = sizes.iter().map(|&name| name.to_owned()).collect();
        let (at, sample) = self.sample.ok_or_else(|| {
            FormatError::new(
                "the header",
                "it has no sample size, against which rules shift points",
                "add SAMPLE SIZE: and one of the sizes",
            )
        })?;
        let found = sizes.iter().position(|name| *name == sample);
        table.sample = found.ok_or_else(|| {
            fault(
                at,
                format!("the sample size {sample:?} is none of the sizes"),
                format!("name one of {}", sizes.join(", ")),
            )
        })?;
        for (line, number, values) in self.rules {
            if values.len() != 2 * sizes.len() {
                return Err(fault(
                    line,
                    format!("rule {number} has {} numbers", values.len()),
                    format!("give two for each of {} sizes", sizes.len()),
                ));
            }
            let pairs = values.chunks_exact(2);
            let shifts: Vec<Vec2> = pairs.map(|pair| Vec2::new(pair[0], pair[1])).collect();
            if table.rules.insert(number, shifts).is_some() {
                return Err(fault(
                    line,
                    format!("rule {number} stands twice"),
                    "leave one of them out",
                ));
            }
        }
        Ok(table)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "ASTM/D13 Proposal 1 Version: D 6673-04\r\nAUTHOR: X\r\n\
        SAMPLE SIZE: M\r\nUNITS: METRIC\r\nGRADE RULE TABLE: T\r\nNUMBER OF SIZES: 3\r\n\
        SIZE LIST: S M L\r\nRULE: DELTA 1\r\n-5.0 2.0 0 0\r\n5 -2\r\nRULE: DELTA 12\r\n\
        .5,-.25, 0,0, -1e1,0\r\nEND\r\nrubbish";

    #[test]
    fn blanks_and_commas_any_order_of_keys() {
        let table = RuleTable::read(TABLE.as_bytes()).unwrap();
        assert_eq!(table.unit, Some(DisplayUnit::Millimetre));
        assert_eq!(table.sizes, ["S", "M", "L"]);
        assert_eq!(table.sample, 1);
        let at = |x, y| Vec2::new(x, y);
        assert_eq!(
            table.rules[&1],
            [at(-5.0, 2.0), at(0.0, 0.0), at(5.0, -2.0)]
        );
        assert_eq!(
            table.rules[&12],
            [at(0.5, -0.25), at(0.0, 0.0), at(-10.0, 0.0)]
        );
        // Names with blanks stand between commas; a list may go on on the next line.
        let long = TABLE.replace("SIZE LIST: S M L", "SIZE LIST: 10 Tall, M\r\n, 2 XL");
        let table = RuleTable::read(long.as_bytes()).unwrap();
        assert_eq!(table.sizes, ["10 Tall", "M", "2 XL"]);
    }

    #[test]
    fn faults_are_told_with_their_line() {
        let told = |from: &str, to: &str| {
            assert!(TABLE.contains(from), "{from}");
            let text = TABLE.replacen(from, to, 1);
            RuleTable::read(text.as_bytes()).unwrap_err().to_string()
        };
        for (from, to, says) in [
            ("SIZE LIST: S M L", "", "no list of sizes"),
            (
                "RULE: DELTA 1\r\n-5.0 2.0 0 0\r\n5 -2\r\nRULE: DELTA 12",
                "",
                "no grade rule table",
            ),
            (
                "SIZE LIST: S M L",
                "SIZE LIST: S M",
                "line 7: the list has 2 sizes",
            ),
            (
                "SIZE LIST: S M L",
                "SIZE LIST: M M L",
                "line 7: size \"M\" stands twice",
            ),
            (
                "SAMPLE SIZE: M",
                "SAMPLE SIZE: XL",
                "line 3: the sample size \"XL\"",
            ),
            ("SAMPLE SIZE: M", "", "no sample size"),
            ("UNITS: METRIC", "UNITS: ELLS", "line 4: the unit \"ells\""),
            ("5 -2", "5", "line 8: rule 1 has 5 numbers"),
            ("5 -2", "5 x", "line 10: \"x\" is no shift"),
            ("5 -2", "5 NaN", "line 10: \"NaN\" is no shift"),
            ("5 -2", "5 1e9", "line 10: \"1e9\" is no shift"),
            ("DELTA 12", "DELTA 1", "line 11: rule 1 stands twice"),
            ("DELTA 12", "STEP 12", "line 11: \"STEP 12\""),
            ("DELTA 12", "DELTA", "line 11: \"DELTA\""),
            (
                "NUMBER OF SIZES: 3",
                "NUMBER OF SIZES: 99999999999",
                "the list has 3 sizes",
            ),
        ] {
            let told = told(from, to);
            assert!(told.contains(says), "{told}");
        }
    }
}
