//! Tables of body measurements of Seamly and Valentina (XML), of one person or for several sizes.

use crate::FormatError;
use crate::measurements_foreign::{put, refuse_empty};
use crate::measurements_formulas::{Written, values_of};
use crate::xml::Xml;
use roxmltree::Node;
use toile_measure::{Measurements, SEAMLY, translated};

/// Difference in size for which the table gives a measurement's `size_increase` (m).
pub(crate) const SIZE_STEP: f64 = 0.02;
/// Difference in body height for which the table gives a measurement's `height_increase` (m).
pub(crate) const HEIGHT_STEP: f64 = 0.06;
/// Smallest and largest size that Seamly and Valentina offer (m).
const SIZES: [f64; 2] = [0.22, 0.72];
/// Smallest and largest body height that Seamly and Valentina offer (m).
const HEIGHTS: [f64; 2] = [0.50, 2.00];

/// The size chosen from a multi-size table; a missing value means the table's base.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SizeChoice {
    /// Size: half the chest girth (m).
    pub size: Option<f64>,
    /// Height of the body (m).
    pub height: Option<f64>,
}

impl SizeChoice {
    /// Whether a size or a height is asked for.
    pub(crate) fn is_given(&self) -> bool {
        self.size.is_some() || self.height.is_some()
    }
}

/// The error for a size chosen from a table of one body.
pub(crate) fn one_size() -> FormatError {
    FormatError::new(
        "size",
        "the table is of one body and has no sizes to choose from",
        "leave out size and height, or give a table for several sizes (.smms, .vst)",
    )
}

/// Reads a measurement file of Seamly2D or Valentina, individual (`.vit`, `.smis`) or for several sizes
/// (`.vst`, `.smms`). One size of several is taken: value = base + (size - base size) / 2 cm times the size
/// increment + (height - base height) / 6 cm times the height increment. A value of zero means not measured.
/// Names are those of the catalogue where it has the same measurement, else those of the file. Also returns
/// notes on the size taken, and on values of a multi-size table that no body can have and that are left out.
///
/// # Errors
/// A unit other than mm, cm and inch; a value that is neither a number nor a formula of other measurements;
/// no value at all; a size or height that the table does not have.
pub fn read_seamly(
    text: &str,
    choice: SizeChoice,
) -> Result<(Measurements, Vec<String>), FormatError> {
    let xml = Xml::read(text, "save the file again, or correct the line")?;
    let scale = unit_of(&xml)?;
    let sizes = Sizes::of(&xml, scale)?;
    let mut notes = Vec::new();
    let steps = match &sizes {
        None if choice.is_given() => return Err(one_size()),
        None => [0.0; 2],
        Some(sizes) => sizes.choose(choice, &mut notes)?,
    };
    let mut rows = rows_of(&xml, steps)?;
    rows.retain(|row| row.number != 0.0);
    if sizes.is_some() {
        let left_out = leave_out(&mut rows, scale).into_iter();
        notes.extend(left_out.map(|rows| format!("left out: {}", rows.why)));
    }
    let mut table = Measurements::new();
    for row in rows {
        let own = match translated(SEAMLY, &row.name) {
            Some(own) => own.to_owned(),
            None => row.name.trim_start_matches('@').to_ascii_lowercase(),
        };
        put(&mut table, &own, row.number, scale)
            .map_err(|what| FormatError::new(place(row.line), what, "correct the line"))?;
    }
    Ok((refuse_empty(table)?, notes))
}

/// Rows of a measurement file, as written there.
#[derive(Clone, Debug, Default)]
pub(crate) struct SeamlyRows {
    /// Size of the file's unit (m).
    pub metres: f64,
    /// Names and numbers in the file's units, also those that are zero.
    pub rows: Vec<(String, f64)>,
    /// Rows of a table for several sizes that no body can have.
    pub impossible: Vec<ImpossibleRows>,
}

/// Rows of a table that no body can have together.
#[derive(Clone, Debug)]
pub(crate) struct ImpossibleRows {
    /// Their names.
    pub names: Vec<String>,
    /// The rows, and why no body can have them, in words.
    pub why: String,
}

/// Base size and base height that a table for several sizes declares (m). `None`: the table is of one body,
/// or gives no steps from size to size.
///
/// # Errors
/// Those of [`read_seamly`].
pub(crate) fn seamly_base(text: &str) -> Result<Option<[f64; 2]>, FormatError> {
    let xml = Xml::read(text, "save the file again, or correct the line")?;
    let sizes = Sizes::of(&xml, unit_of(&xml)?)?;
    Ok(sizes
        .filter(|sizes| !sizes.inches)
        .and_then(|sizes| sizes.base))
}

/// The rows of a measurement file in the chosen size, with the file's names and units.
///
/// # Errors
/// Those of [`read_seamly`].
pub(crate) fn seamly_rows(text: &str, choice: SizeChoice) -> Result<SeamlyRows, FormatError> {
    let xml = Xml::read(text, "save the file again, or correct the line")?;
    let metres = unit_of(&xml)?;
    let sizes = Sizes::of(&xml, metres)?;
    let steps = match &sizes {
        None if choice.is_given() => return Err(one_size()),
        None => [0.0; 2],
        Some(sizes) => sizes.choose(choice, &mut Vec::new())?,
    };
    let mut rows = rows_of(&xml, steps)?;
    let named = rows.iter().map(|row| (row.name.clone(), row.number));
    let named = named.collect();
    let mut impossible = Vec::new();
    if sizes.is_some() {
        rows.retain(|row| row.number != 0.0);
        impossible = leave_out(&mut rows, metres);
    }
    Ok(SeamlyRows {
        metres,
        rows: named,
        impossible,
    })
}

fn place(line: usize) -> String {
    format!("line {line}")
}

fn is(node: Node<'_, '_>, name: &str) -> bool {
    node.tag_name().name() == name
}

/// Size of the file's unit (m).
fn unit_of(xml: &Xml<'_>) -> Result<f64, FormatError> {
    let node = xml.elements().find(|node| is(*node, "unit"));
    let unit = node.and_then(|node| node.text()).unwrap_or("cm").trim();
    match unit {
        "mm" => Ok(1e-3),
        "cm" => Ok(1e-2),
        "inch" | "in" => Ok(0.0254),
        other => Err(FormatError::new(
            "unit",
            format!("{other:?} is not a unit this program knows"),
            "save the file in mm, cm or inch",
        )),
    }
}

/// The base size that a multi-size table declares.
struct Sizes {
    /// Base size and base height (m); `None` if the table has dimensions of another kind.
    base: Option<[f64; 2]>,
    /// Whether the table is in inches: there are no increments for inches.
    inches: bool,
}

impl Sizes {
    /// The sizes of a table; `None` for a table of one body.
    fn of(xml: &Xml<'_>, scale: f64) -> Result<Option<Self>, FormatError> {
        let base = |name: &str| -> Result<Option<f64>, FormatError> {
            let node = xml
                .elements()
                .find(|node| is(*node, name) && node.has_attribute("base"));
            let Some(node) = node else { return Ok(None) };
            let number = number_of(node, ("base", name), xml.line(node))?;
            Ok(number.map(|number| number * scale))
        };
        let (size, height) = (base("size")?, base("height")?);
        let several = matches!(xml.root().tag_name().name(), "vst" | "smms");
        if !several && size.is_none() {
            return Ok(None);
        }
        Ok(Some(Self {
            base: size.zip(height).map(|(size, height)| [size, height]),
            inches: scale == 0.0254,
        }))
    }

    /// Number of size and height steps from the base to the chosen size.
    fn choose(&self, choice: SizeChoice, notes: &mut Vec<String>) -> Result<[f64; 2], FormatError> {
        let others = "`toile body --measurements` takes another by --size and --height, and writes a body for `toile make --body`";
        let Some(base) = self.base else {
            if choice.is_given() {
                return Err(FormatError::new(
                    "size",
                    "the table does not say its base size and height, as Seamly and older Valentina do",
                    "leave out size and height to take its base, or save the size as an individual file",
                ));
            }
            notes.push("the table is for several sizes: its base is taken".to_owned());
            return Ok([0.0; 2]);
        };
        if self.inches && choice.is_given() {
            return Err(FormatError::new(
                "unit",
                "tables in inches have no increments from size to size",
                "leave out size and height, or save the table in cm",
            ));
        }
        let chosen = [
            choice.size.unwrap_or(base[0]),
            choice.height.unwrap_or(base[1]),
        ];
        for ((what, given), (value, [low, high])) in
            [("size", choice.size), ("height", choice.height)]
                .into_iter()
                .zip(chosen.into_iter().zip([SIZES, HEIGHTS]))
        {
            let within = value >= low - 1e-9 && value <= high + 1e-9;
            if given.is_some() && !within {
                return Err(FormatError::new(
                    what,
                    format!("the table has no {what} {}", in_cm(value)),
                    format!(
                        "give sizes from {} to {} and heights from {} to {} cm; its base is {}",
                        in_cm(SIZES[0]),
                        in_cm(SIZES[1]),
                        in_cm(HEIGHTS[0]),
                        in_cm(HEIGHTS[1]),
                        words(base),
                    ),
                ));
            }
        }
        notes.push(match choice.is_given() {
            true => format!(
                "the table is for several sizes: {} is taken; its base is {}",
                words(chosen),
                words(base)
            ),
            false => format!(
                "the table is for several sizes: its base, {}, is taken; {others}",
                words(base)
            ),
        });
        Ok([
            (chosen[0] - base[0]) / SIZE_STEP,
            (chosen[1] - base[1]) / HEIGHT_STEP,
        ])
    }
}

/// A length in centimetres, the unit in which sizes are named.
fn in_cm(metres: f64) -> String {
    let rounded = (metres * 1e4).round() / 1e2;
    rounded.to_string()
}

fn words([size, height]: [f64; 2]) -> String {
    format!("size {} of height {} cm", in_cm(size), in_cm(height))
}

/// The measurements of a file; `steps` are the numbers of size and height steps from the base.
fn rows_of(xml: &Xml<'_>, steps: [f64; 2]) -> Result<Vec<Row>, FormatError> {
    let (mut written, mut growths) = (Vec::new(), Vec::new());
    for node in xml.elements().filter(|node| is(*node, "m")) {
        let row = written_of(node, xml.line(node))?;
        growths.push(growth(node, &row, steps)?);
        written.push(row);
    }
    let values = values_of(&written)?;
    let grown = values.into_iter().zip(growths);
    let row = |(row, (value, growth)): (Written, (f64, f64))| Row {
        line: row.line,
        name: row.name,
        number: value + growth,
    };
    Ok(written.into_iter().zip(grown).map(row).collect())
}

/// A measurement of a file, with the file's name and unit.
struct Row {
    line: usize,
    name: String,
    number: f64,
}

/// The value of a measurement as written.
fn written_of(node: Node<'_, '_>, line: usize) -> Result<Written, FormatError> {
    let Some(name) = node.attribute("name").filter(|name| !name.is_empty()) else {
        return Err(FormatError::new(
            place(line),
            "a measurement without a name",
            "name it",
        ));
    };
    let Some(text) = node.attribute("value").or(node.attribute("base")) else {
        return Err(FormatError::new(
            place(line),
            format!("{name:?} has no value"),
            "give it a number",
        ));
    };
    Ok(Written {
        line,
        name: name.to_owned(),
        text: text.to_owned(),
    })
}

/// Growth of a measurement from the base, in the file's unit; `steps` are the numbers of size and height steps.
fn growth(node: Node<'_, '_>, row: &Written, steps: [f64; 2]) -> Result<f64, FormatError> {
    let number = |field: &str| number_of(node, (field, &row.name), row.line);
    let increments = [number("size_increase")?, number("height_increase")?];
    let each = increments.into_iter().zip(steps);
    Ok(each
        .map(|(increment, step)| increment.unwrap_or_default() * step)
        .sum())
}

/// A field of an element as a number; `None` if the element does not have it.
fn number_of(
    node: Node<'_, '_>,
    (field, name): (&str, &str),
    line: usize,
) -> Result<Option<f64>, FormatError> {
    let Some(text) = node.attribute(field) else {
        return Ok(None);
    };
    let number: Option<f64> = text.trim().parse().ok();
    match number.filter(|number| number.is_finite()) {
        Some(number) => Ok(Some(number)),
        None => Err(FormatError::new(
            place(line),
            format!("the {field} of {name:?} is {text:?}, not a number"),
            "give a number",
        )),
    }
}

/// Checks on a table, since some published tables give a name to another measurement. Each check holds a
/// measurement, a factor, a second measurement, the names to leave out, and the reason: if the first
/// measurement is not less than the factor times the second, the measurements of these names are left out.
const LESS: [(&str, f64, &str, &[&str], &str); 3] = [
    (
        "waist_to_highhip_f",
        1.0,
        "waist_to_hip_f",
        &["waist_to_highhip_f", "waist_to_hip_f"],
        "the hips lie below the high hips",
    ),
    (
        "height_armpit",
        1.0,
        "height_shoulder_tip",
        &["height_shoulder_tip"],
        "the tip of the shoulder lies above the armpit",
    ),
    (
        "neck_circ",
        1.5,
        "neck_mid_circ",
        &["neck_mid_circ"],
        "the middle of the neck has more than two thirds of the girth at its base",
    ),
];

/// Removes values that no body can have, and returns them.
fn leave_out(rows: &mut Vec<Row>, scale: f64) -> Vec<ImpossibleRows> {
    let shown = |row: &Row| {
        format!(
            "line {}, {} of {} cm",
            row.line,
            row.name,
            in_cm(row.number * scale)
        )
    };
    let mut found = Vec::new();
    rows.retain(|row| {
        let kept = row.number > 0.0;
        if !kept {
            found.push(ImpossibleRows {
                names: vec![row.name.clone()],
                why: format!("{}: it is not above 0", shown(row)),
            });
        }
        kept
    });
    for (less, times, more, out, why) in LESS {
        let number = |name: &str| {
            rows.iter()
                .find(|row| row.name == name)
                .map(|row| row.number)
        };
        let (Some(first), Some(second)) = (number(less), number(more)) else {
            continue;
        };
        if first < times * second {
            continue;
        }
        let is_out = |row: &Row| out.contains(&row.name.as_str());
        let gone = || rows.iter().filter(|row| is_out(row));
        let words: Vec<String> = gone().map(shown).collect();
        found.push(ImpossibleRows {
            names: gone().map(|row| row.name.clone()).collect(),
            why: format!("{}: {why}", words.join("; ")),
        });
        rows.retain(|row| !is_out(row));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read_measurements;
    use proptest::prelude::*;

    #[test]
    fn individual_and_multisize_files_become_si() {
        let file = |unit: &str, rows: &str| {
            format!(
                "<?xml version='1.0'?>\n<vit>\n<unit>{unit}</unit>\n<body-measurements>\n{rows}</body-measurements></vit>"
            )
        };
        let rows = "<m name=\"height\" value=\"173\"/>\n<m value='24 ' name='hand_circ'/>\n\
                    <m name=\"neck_circ\" value=\"0\"/>\n<m name=\"waist_circ\" value=\"92\"/>\n\
                    <m name=\"shoulder_slope_neck_side_angle\" value=\"22\"/>";
        let table = read_measurements(&file("cm", rows)).unwrap();
        assert_eq!(table.get("height"), Some(1.73));
        assert_eq!(table.get("waist"), Some(0.92));
        assert_eq!(table.get("hand_circ"), Some(0.24));
        assert_eq!(table.get("shoulder_incl"), Some(22f64.to_radians()));
        assert!(!table.contains("neck_base"), "zero is not measured");
        let rows = "<m base=\"1760\" height_increase=\"60\" name=\"height\" size_increase=\"0\"/>";
        assert_eq!(
            read_seamly(&file("mm", rows), SizeChoice::default())
                .unwrap()
                .0
                .get("height"),
            Some(1.76)
        );
        let place = |text: &str| read_seamly(text, SizeChoice::default()).unwrap_err().place;
        assert_eq!(place(&file("ell", rows)), "unit");
        assert_eq!(
            place(&file("cm", "<m name=\"height\" value=\"waist*2\"/>")),
            "line 5"
        );
        assert_eq!(place(&file("cm", "<m value=\"1\"/>")), "line 5");
        assert_eq!(place(&file("cm", "")), "the file");
    }

    /// A table for several sizes, in mm: base size 50, base height 176 cm.
    const SEVERAL: &str = "<?xml version='1.0'?>\n<vst><unit>mm</unit>\n\
        <size base='500'/>\n<height base='1760'/>\n<body-measurements>\n\
        <m name='height' base='1760' size_increase='0' height_increase='60'/>\n\
        <m name='bust_circ' base='1044' size_increase='38' height_increase='2'/>\n\
        <m name='head_length' base='246' size_increase='-2' height_increase='6'/>\n\
        </body-measurements></vst>";

    fn chosen(size: Option<f64>, height: Option<f64>) -> SizeChoice {
        SizeChoice { size, height }
    }

    #[test]
    fn of_several_sizes_one_is_chosen_by_its_increments() {
        let near = |a: Option<f64>, b: f64| (a.unwrap() - b).abs() < 1e-9;
        let (table, notes) = read_seamly(SEVERAL, chosen(Some(0.54), Some(1.70))).unwrap();
        assert!(near(table.get("height"), 1.700));
        // Two sizes larger and one height step smaller.
        assert!(near(table.get("bust"), 1.044 + 2.0 * 0.038 - 0.002));
        assert!(near(table.get("head_height"), 0.246 - 2.0 * 0.002 - 0.006));
        let note = "the table is for several sizes: size 54 of height 170 cm is taken; its base is size 50 of height 176 cm";
        assert_eq!(notes, [note]);
        let (base, notes) = read_seamly(SEVERAL, chosen(None, None)).unwrap();
        assert!(near(base.get("bust"), 1.044));
        let words = ["its base, size 50 of height 176 cm, is taken", "toile body"];
        assert!(words.iter().all(|w| notes[0].contains(w)), "{notes:?}");
        // Size or height may be left out.
        let (wide, _) = read_seamly(SEVERAL, chosen(Some(0.52), None)).unwrap();
        assert!(near(wide.get("bust"), 1.044 + 0.038) && near(wide.get("height"), 1.76));
    }

    #[test]
    fn sizes_that_a_table_does_not_have_are_refused_with_those_it_has() {
        for (choice, place, what) in [
            (chosen(Some(5.0), None), "size", "no size 500"),
            (chosen(Some(0.2), None), "size", "no size 20"),
            (chosen(None, Some(2.5)), "height", "no height 250"),
            (chosen(Some(f64::NAN), None), "size", "no size"),
        ] {
            let error = read_seamly(SEVERAL, choice).unwrap_err();
            assert_eq!(error.place, place);
            assert!(error.what.contains(what), "{error}");
            let there = "sizes from 22 to 72 and heights from 50 to 200 cm; its base is size 50 of height 176 cm";
            assert!(error.hint.contains(there), "{error}");
        }
        let size = chosen(Some(0.5), None);
        let one = "<vit><unit>cm</unit><m name='height' value='170'/></vit>";
        assert_eq!(read_seamly(one, size).unwrap_err(), one_size());
        let yaml = "body:\n  height: 170\n";
        assert_eq!(
            crate::read_sized_measurements(yaml, size).unwrap_err(),
            one_size()
        );
        let inches = SEVERAL.replace("mm<", "inch<");
        assert_eq!(read_seamly(&inches, size).unwrap_err().place, "unit");
        let newer = "<vst><unit>cm</unit><dimensions><dimension type='x' base='176'/></dimensions>\
            <m name='height' base='176' shiftA='6'/></vst>";
        assert_eq!(read_seamly(newer, size).unwrap_err().place, "size");
        let (table, notes) = read_seamly(newer, chosen(None, None)).unwrap();
        assert!(table.get("height") == Some(1.76) && notes[0].contains("base is taken"));
        let word = SEVERAL.replace("'38'", "'wide'");
        assert_eq!(read_seamly(&word, size).unwrap_err().place, "line 7");
    }

    #[test]
    fn what_no_body_has_is_left_out_of_a_table_of_sizes_and_told() {
        let rows = "<m name='waist_to_highhip_f' base='64'/>\n<m name='waist_to_hip_f' base='37'/>\n\
            <m name='height_armpit' base='1328'/><m name='height_shoulder_tip' base='67'/>\n\
            <m name='neck_circ' base='404'/><m name='neck_mid_circ' base='205'/></body-m";
        let text = SEVERAL.replace("</body-m", rows);
        let (table, notes) = read_seamly(&text, chosen(None, None)).unwrap();
        for name in ["hips_line", "waist_to_high_hips", "shoulder_height", "neck"] {
            assert!(!table.contains(name), "{name}");
        }
        assert_eq!(table.get("armpit_height"), Some(1.328));
        let told = "left out: line 9, waist_to_highhip_f of 6.4 cm; line 10, waist_to_hip_f of 3.7 cm: the hips lie below the high hips";
        assert_eq!(notes[1], told);
        assert!(
            notes.len() == 4 && notes[2].contains("height_shoulder_tip"),
            "{notes:?}"
        );
        // A table of one person is kept as it is.
        let own = text
            .replace("<size base='500'/>", "")
            .replace("vst>", "vit>");
        let (table, notes) = read_seamly(&own, chosen(None, None)).unwrap();
        assert_eq!((table.get("hips_line"), notes.len()), (Some(0.037), 0));
    }

    #[test]
    fn comments_and_entities_and_single_quotes_are_what_they_are_in_xml() {
        let text = "<!DOCTYPE vit [ <!ENTITY waist '84'> ]>\n<vit><unit><![CDATA[cm]]></unit>\n\
            <!-- <m name=\"height\" value=\"99\"/> -->\n<m description='a > b' name='height' value='1&#55;0'/>\n\
            <m value='&waist;' name='waist_circ'/></vit>";
        let table = crate::read_measurements(text).unwrap();
        assert_eq!(
            (table.get("height"), table.get("waist")),
            (Some(1.7), Some(0.84))
        );
        let open = read_seamly("<vit>\n<m name='height' value='1'>", chosen(None, None));
        assert_eq!(open.unwrap_err().place, "line 2");
    }

    #[test]
    fn files_of_both_programs_are_read() {
        let start = std::path::PathBuf::from(env!("CARGO_MANIFEST_DIR"));
        let found = start
            .ancestors()
            .map(|f| f.join("shared/data"))
            .find(|f| f.is_dir());
        let Some(folder) = found else {
            return;
        };
        for (file, least) in [
            ("valentina/MaleShirt.vit", 8),
            ("valentina/GOST_man_ru.vst", 60),
            ("seamly/male_shirt.smis", 8),
            ("seamly/trousers.smis", 8),
            ("seamly/gost_man_ru.smms", 60),
        ] {
            let text = std::fs::read_to_string(folder.join(file)).unwrap();
            let table = read_measurements(&text).unwrap();
            assert!(table.len() >= least, "{file}: {}", table.len());
        }
    }

    proptest! {
        #[test]
        fn any_text_is_read_or_refused(text in "<(m name=\"[a-z_]{0,9}\" (value|base)=\"[0-9.e-]{0,5}\"/>|[a-z <>/=\"']{0,30})*") {
            if let Ok((table, _)) = read_seamly(&text, SizeChoice::default()) {
                prop_assert!(table.iter().all(|(_, m)| m.value.is_finite()));
            }
        }
    }
}
