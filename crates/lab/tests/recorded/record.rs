//! A file of results, and how what is computed now is held to it.

use std::fmt::Write;
use std::path::PathBuf;
use toile_geometry::Vec3;

/// Results as they are computed: a line each, a name and its numbers. What begins with `#` is a hash.
pub struct Record {
    name: &'static str,
    /// Most that numbers differ by on another processor, as a share of the largest of their line.
    tolerance: f64,
    text: String,
}

/// Numbers of a long list that are recorded themselves, beside its hash.
const SAMPLES: usize = 6;

impl Record {
    pub fn new(name: &'static str, tolerance: f64) -> Self {
        Self {
            name,
            tolerance,
            text: format!("machine: {}\n", machine()),
        }
    }

    /// Notes numbers.
    pub fn numbers(&mut self, name: &str, numbers: &[f64]) {
        write!(self.text, "{name}:").unwrap();
        for number in numbers {
            write!(self.text, " {number:e}").unwrap();
        }
        self.text.push('\n');
    }

    /// Notes words, which hold on every machine.
    pub fn words(&mut self, name: &str, words: &str) {
        let words = words.replace('\n', " ");
        writeln!(self.text, "{name}: {words:?}").unwrap();
    }

    /// Notes a long list by its norm, some of its numbers, and a hash of all its bits.
    pub fn list(&mut self, name: &str, numbers: impl IntoIterator<Item = f64>) {
        let numbers: Vec<f64> = numbers.into_iter().collect();
        let norm = numbers.iter().map(|x| x * x).sum::<f64>().sqrt();
        write!(
            self.text,
            "{name}: ({}) #{:016x} {norm:e}",
            numbers.len(),
            hash(&numbers)
        )
        .unwrap();
        for k in 0..SAMPLES.min(numbers.len()) {
            let number = numbers[k * numbers.len() / SAMPLES.min(numbers.len())];
            write!(self.text, " {number:e}").unwrap();
        }
        self.text.push('\n');
    }

    /// The same of vectors.
    pub fn vectors(&mut self, name: &str, vectors: &[Vec3]) {
        self.list(name, vectors.iter().flat_map(|v| [v.x, v.y, v.z]));
    }

    /// Holds what was computed to the file, or writes it.
    pub fn hold(self) {
        let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/recorded");
        let path = folder.join(format!("{}.txt", self.name));
        let before = std::fs::read_to_string(&path).unwrap_or_default();
        if std::env::var_os("TOILE_RECORD").is_some() {
            println!("{}: {}", self.name, largest_change(&before, &self.text));
            std::fs::write(&path, &self.text).unwrap();
            return;
        }
        let first = |text: &str| text.lines().next().map(str::to_owned);
        let tolerance = match first(&before) == first(&self.text) {
            true => None,
            false => Some(self.tolerance),
        };
        let (old, new) = (before.lines().skip(1), self.text.lines().skip(1));
        let differing: Vec<String> = old
            .zip(new)
            .filter(|(old, new)| !is_same(old, new, tolerance))
            .map(|(old, new)| format!("- {old}\n+ {new}"))
            .collect();
        assert_eq!(
            before.lines().count(),
            self.text.lines().count(),
            "{}",
            self.name
        );
        assert!(
            differing.is_empty(),
            "{} lines of {}.txt differ, the first:\n{}",
            differing.len(),
            self.name,
            differing[..differing.len().min(5)].join("\n")
        );
    }
}

/// Instructions that decide in which order sums are taken.
fn machine() -> String {
    let mut found = vec![std::env::consts::ARCH];
    #[cfg(target_arch = "x86_64")]
    for (name, has) in [
        ("avx2", is_x86_feature_detected!("avx2")),
        ("fma", is_x86_feature_detected!("fma")),
        ("avx512f", is_x86_feature_detected!("avx512f")),
    ] {
        if has {
            found.push(name);
        }
    }
    found.join(" ")
}

/// FNV-1a over the bits; nought has one sign.
fn hash(numbers: &[f64]) -> u64 {
    let bytes = numbers
        .iter()
        .flat_map(|x| (x + 0.0).to_bits().to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// Whether two lines say the same: to the byte, or within a share of the largest number.
fn is_same(old: &str, new: &str, tolerance: Option<f64>) -> bool {
    old == new || tolerance.is_some_and(|tolerance| change(old, new) <= tolerance)
}

/// How far the numbers of a line are from those of another, as a share of the largest; infinite
/// where anything else differs. Hashes do not count.
fn change(old: &str, new: &str) -> f64 {
    let is_words = old.contains(": \"");
    let (old, new): (Vec<&str>, Vec<&str>) = (
        old.split_whitespace().collect(),
        new.split_whitespace().collect(),
    );
    if old.len() != new.len() {
        return f64::INFINITY;
    }
    // Of words the numbers in them do not count.
    if is_words {
        let is_same =
            |(a, b): (&&str, &&str)| a == b || a.contains(is_digit) && b.contains(is_digit);
        let same = old.iter().zip(&new).all(is_same);
        return if same { 0.0 } else { f64::INFINITY };
    }
    let (mut largest, mut apart) = (0.0f64, 0.0f64);
    for (old, new) in old.into_iter().zip(new) {
        match (old.parse::<f64>(), new.parse::<f64>()) {
            (Ok(a), Ok(b)) => {
                largest = largest.max(a.abs());
                apart = apart.max((a - b).abs());
            }
            _ if old.starts_with('#') || old == new => {}
            _ => return f64::INFINITY,
        }
    }
    if apart == 0.0 { 0.0 } else { apart / largest }
}

fn is_digit(c: char) -> bool {
    c.is_ascii_digit()
}

fn largest_change(before: &str, now: &str) -> String {
    if before.lines().count() != now.lines().count() {
        return format!(
            "{} lines, before {}",
            now.lines().count(),
            before.lines().count()
        );
    }
    let changes = before.lines().zip(now.lines()).skip(1);
    let changed = changes.clone().filter(|(old, new)| old != new).count();
    let largest = changes
        .map(|(old, new)| (change(old, new), new))
        .max_by(|a, b| a.0.total_cmp(&b.0));
    match largest {
        Some((by, line)) if changed > 0 => {
            let name = line.split(':').next().unwrap_or_default();
            format!("{changed} lines changed, the largest by {by:e}: {name}")
        }
        _ => "nothing changed".to_owned(),
    }
}
