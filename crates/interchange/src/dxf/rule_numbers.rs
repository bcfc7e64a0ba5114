//! Grade rules of a pattern that is written: numbers of shifts, and the table with them (RUL).

use super::writer::{number, plain};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use toile_geometry::Vec2;

/// Shifts that differ by less have one number (m).
const SAME: f64 = 1e-6;
/// Pairs of shifts in a line of the table.
const IN_LINE: usize = 4;

/// Numbers of the shifts of points, given in the order in which points ask.
pub(super) struct RuleNumbers {
    known: BTreeMap<Vec<[i64; 2]>, usize>,
    /// Shifts against the first size by number, from 1, in the order of the drafts (m).
    shifts: Vec<Vec<Vec2>>,
}

impl RuleNumbers {
    /// The rule 1 alone, which moves nothing.
    pub fn new(sizes: usize) -> Self {
        let mut numbers = Self {
            known: BTreeMap::new(),
            shifts: Vec::new(),
        };
        numbers.of(&vec![Vec2::zeros(); sizes]);
        numbers
    }

    /// The number of the rule of a point at places in all sizes (m).
    pub fn of(&mut self, places: &[Vec2]) -> usize {
        let usual = places.first().copied().unwrap_or_default();
        let shifts: Vec<Vec2> = places.iter().map(|p| p - usual).collect();
        let steps = |value: f64| (value / SAME).round() as i64;
        let key = shifts.iter().map(|by| [steps(by.x), steps(by.y)]).collect();
        *self.known.entry(key).or_insert_with(|| {
            self.shifts.push(shifts);
            self.shifts.len()
        })
    }

    /// The table: `sizes` are the names of the drafts' sizes, the sample size first, `order` their indices from
    /// small to large.
    pub fn table(&self, name: &str, sizes: &[&str], order: &[usize], is_astm: bool) -> String {
        let mut text = String::from(match is_astm {
            true => "ASTM/D13 Proposal 1 Version: D 6673-10\n",
            false => "version ANSI/AAMA-292-B\n",
        });
        let names: Vec<String> = order.iter().map(|&k| size_name(sizes[k])).collect();
        let gap = match names.iter().any(|name| name.contains(' ')) {
            true => ", ",
            false => " ",
        };
        let sample = sizes
            .first()
            .map_or_else(String::new, |name| size_name(name));
        let version = env!("CARGO_PKG_VERSION");
        let _ = write!(
            text,
            "AUTHOR: Toile\nPRODUCT: Toile\nVERSION: {version}\nUNITS: METRIC\n\
             GRADE RULE TABLE: {}\nNUMBER OF SIZES: {}\nSIZE LIST: {}\nSAMPLE SIZE: {sample}\n",
            plain(name),
            names.len(),
            names.join(gap),
        );
        for (k, shifts) in self.shifts.iter().enumerate() {
            let _ = writeln!(text, "RULE: DELTA {}", k + 1);
            let pairs: Vec<String> = order
                .iter()
                .map(|&k| {
                    let by = shifts[k] * 1e3;
                    format!("{} {}", number(by.x), number(by.y))
                })
                .collect();
            for line in pairs.chunks(IN_LINE) {
                let _ = writeln!(text, "{}", line.join("  "));
            }
        }
        text + "END\n"
    }
}

/// The name of a size as it stands in a list with blanks or commas.
fn size_name(name: &str) -> String {
    plain(name).replace([',', ':'], ".")
}
