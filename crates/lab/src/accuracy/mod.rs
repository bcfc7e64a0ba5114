//! The page of accuracy: sections of one claim each, measured by what measures it elsewhere, and
//! written into a document between its markers.

mod benches;
mod garments;
mod patterns;
mod provenance;

pub use provenance::provenance;

use crate::clock::Clock;
use crate::{
    ChartPlan, LAWS, LabError, chart, chart_files, hard_cases, law_table, limits, stability_files,
    stability_map, stability_table, validate, when_to_use, with_section, write_files,
};
use std::path::{Path, PathBuf};
use toile_interchange::{read_text, write_atomically};
use toile_session::Watcher;

/// A claim about speed or accuracy, and how its table is measured.
pub struct Section {
    /// Its name on the command line, and in the markers of the document.
    pub name: &'static str,
    /// Its heading.
    pub title: &'static str,
    /// What is claimed and how the columns are to be read, as Markdown.
    pub claim: &'static str,
    /// The command that measures the same without the others.
    pub command: &'static str,
    measure: fn(&mut dyn Watcher) -> Result<Content, LabError>,
}

/// The results of a section.
#[derive(Default)]
struct Content {
    /// Tables, as Markdown.
    tables: String,
    /// Charts: name and content of each file.
    charts: Vec<(String, String)>,
}

impl From<String> for Content {
    fn from(tables: String) -> Self {
        Self {
            tables,
            charts: Vec::new(),
        }
    }
}

/// A section as it was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Its name.
    pub name: &'static str,
    /// Heading, claim, tables, command and cost, as Markdown.
    pub text: String,
    /// Charts: name and content of each file.
    pub charts: Vec<(String, String)>,
    /// Wall time (s).
    pub wall_s: f64,
    /// Processor time (s); wall time where the system does not tell it.
    pub cpu_s: f64,
}

/// Every section, in the order of the page.
pub static SECTIONS: [Section; 10] = [
    Section {
        name: "laws",
        title: "Laws",
        claim: "Closed forms of mechanics that the simulation is held to. Of each law the check that comes nearest to its tolerance, or exceeds it \
                farthest, is shown: the error, what is allowed, and the case. `toile validate --list` says what each law is and prints every tolerance. Six laws take minutes and \
                are left out here: `toile validate cantilever resolution swing vibration flight corner` ([last results](methods/laws.md#measured-tried-and-left)).",
        command: "toile validate",
        measure: laws,
    },
    Section {
        name: "stability",
        title: "Methods: where they fail",
        claim: "An explicit method blows up at the step that its stability limit gives, the limit over the largest frequency w of the cloth at rest. In a hard case \
                a method either keeps a possible state or stops with an error that names stage and vertex; *unsound* is one that goes on with an impossible \
                state ([how it is told](methods/lab.md#stability)). The map at every step and \
                stiffness: [stability.svg](charts/stability.svg).",
        command: "toile stability",
        measure: stability,
    },
    Section {
        name: "chart",
        title: "Methods: speed against accuracy",
        claim: "For each scene the run that took the least processor time within an error, in ms a simulated second. The error is the root of the mean squared \
                distance of all vertices to the converged end of the motion ([how](methods/lab.md#speed-against-accuracy)). Two steps on coarse meshes, \
                0.4 s of processor time a run; `toile chart` without `--quick` takes all steps and meshes. In brackets: iterations a step at the most. \
                Charts and CSV files: [charts/](charts/).",
        command: "toile chart --quick",
        measure: speed_against_accuracy,
    },
    Section {
        name: "garments",
        title: "Garments",
        claim: "The patterns that ship, in their base size on the woman it is for, as `preview` (25 mm edges, net force under 1e-2 of the weight asked for) \
                and as `fit` (15 mm, 5e-3). Crossings of the cloth with the body and with itself are counted exactly; seam gaps are those before merging; \
                times are of the whole job, marker, pictures and files included.",
        command: "toile make PATTERN --quality QUALITY",
        measure: garments::one_by_one,
    },
    Section {
        name: "layers",
        title: "Garments over one another",
        claim: "Three garments on the woman at `preview`, innermost first. Counted exactly at the end: crossings with the body, of cloth with cloth of one layer, of \
                layer with layer; astray are vertices on the wrong side of a layer.",
        command: "toile drape PATTERN PATTERN PATTERN --quality preview --body woman",
        measure: garments::layered,
    },
    Section {
        name: "contact",
        title: "Cloth against cloth",
        claim: "What finding contacts and crossings takes: on a waved sheet, and on a worn shirt, with all regions looked into and with those \
                left out whose curvature keeps them apart. Then frames of XPBD (1/60 s, 20 substeps; 10 for the square on the ball) with contact and without. \
                Wall time and, in brackets, processor time on one thread / on two.",
        command: benches::CONTACT_COMMAND,
        measure: benches::contact,
    },
    Section {
        name: "factor",
        title: "Factorisation",
        claim: "Matrices with the pattern of Newton's method on cloth (31 entries a row, 3 unknowns a vertex), factorised and solved with: the least of five \
                wall times and, in brackets, processor times on one thread / on two, of two for the largest. The error is |b - A x| / |b|.",
        command: benches::FACTOR_COMMAND,
        measure: benches::factorisation,
    },
    Section {
        name: "meshes",
        title: "Meshes",
        claim: "Panels of the patterns that ship, triangulated with edges of 10 mm. Angles in triangles that a sharp corner of the panel makes sharp are left out.",
        command: "toile mesh PATTERN --edge 10mm --out F",
        measure: patterns::meshes,
    },
    Section {
        name: "markers",
        title: "Marker making",
        claim: "The patterns that ship, one garment of the base size and one of each of the six sizes together, 20 million evaluations from seed 1 (the same bytes on any \
                number of threads), with their gaps and selvedges. Efficiency is the area of the pieces over the full width. The referee, which shares no code \
                with the search but the geometry, passed a marker or did not.",
        command: "toile nest PATTERN --evaluations 20000000 [--sizes XS:1,S:1,M:1,L:1,XL:1,XXL:1]",
        measure: patterns::markers,
    },
    Section {
        name: "drag",
        title: "Drafting: a drag",
        claim: "One pointer move of a drag as the window makes it, without checks and drawing, beside evaluating everything afresh: medians of moves, then of points. \
                The large pattern is made by rule: 200 panels of 100 points, with curves, darts, notches, seams and formulas. An evaluation that is kept up to \
                date equals a fresh one to the bit (`cargo test -p toile-pattern plans::kept`).",
        command: "toile bench drag",
        measure: benches::drag,
    },
];

/// The sections named, or all, in the order of [`SECTIONS`].
///
/// # Errors
/// A name that is no section.
pub fn sections_named(names: &[String]) -> Result<Vec<&'static Section>, LabError> {
    let known = || SECTIONS.each_ref().map(|section| section.name).join(", ");
    let is_known = |name: &&String| SECTIONS.iter().any(|section| section.name == **name);
    if let Some(name) = names.iter().find(|name| !is_known(name)) {
        return Err(LabError::Unknown {
            what: "section",
            name: name.clone(),
            known: known(),
        });
    }
    let chosen = SECTIONS
        .iter()
        .filter(|section| names.is_empty() || names.iter().any(|name| name == section.name));
    Ok(chosen.collect())
}

impl Section {
    /// Measures the claim.
    ///
    /// # Errors
    /// The watcher asked to stop, or a file of the laboratory is damaged. What fails is a row that
    /// says so.
    pub fn measure(&self, watcher: &mut dyn Watcher) -> Result<Measured, LabError> {
        let clock = Clock::start();
        let content = (self.measure)(watcher)?;
        let (wall_s, cpu_s) = (clock.wall(), clock.spent());
        Ok(Measured {
            name: self.name,
            text: format!(
                "## {}\n\n{} `{}`: {wall_s:.0} s, {cpu_s:.0} s of processor time.\n\n{}",
                self.title,
                self.claim,
                self.command,
                content.tables.trim(),
            ),
            charts: content.charts,
            wall_s,
            cpu_s,
        })
    }
}

/// Name of the section that says where and of what the others were measured.
const HEAD: &str = "measured";

/// A document with the sections measured in place of its own. Where all were measured, its head
/// says where and of what ([`provenance()`]); else each of those measured says so itself.
pub fn page(document: &str, measured: &[Measured], provenance: &str) -> String {
    let whole = measured.len() == SECTIONS.len();
    let mut page = match whole {
        true => with_section(document, HEAD, provenance),
        false => document.to_owned(),
    };
    for section in measured {
        let text = match whole {
            true => section.text.clone(),
            false => format!("{}\n\n{provenance}", section.text),
        };
        page = with_section(&page, section.name, &text);
    }
    page
}

/// The folder of charts beside a document.
pub fn charts_beside(document: &Path) -> PathBuf {
    document.with_file_name("charts")
}

/// Writes the sections measured into a document, see [`page`], and their charts into the folder
/// `charts` beside it. `provenance` is to be taken before they are measured. Files written.
///
/// # Errors
/// The document cannot be read, or a file cannot be written.
pub fn write_page(
    document: &Path,
    measured: &[Measured],
    provenance: &str,
) -> Result<Vec<PathBuf>, LabError> {
    let failed = |what: String| LabError::Files { what };
    let text = read_text(document).map_err(|error| failed(error.to_string()))?;
    let charts: Vec<(String, String)> = measured
        .iter()
        .flat_map(|section| section.charts.iter().cloned())
        .collect();
    let mut written = match charts.is_empty() {
        true => Vec::new(),
        false => write_files(&charts_beside(document), &charts)?,
    };
    let page = page(&text, measured, provenance);
    write_atomically(document, page.as_bytes()).map_err(|error| failed(error.to_string()))?;
    written.push(document.to_owned());
    Ok(written)
}

/// A table as Markdown.
fn markdown(columns: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let names: Vec<String> = columns.iter().map(|name| (*name).to_owned()).collect();
    let mut text = line(&names) + &"|---".repeat(columns.len()) + "|\n";
    for mut row in rows {
        row.resize(columns.len(), String::new());
        text += &line(&row);
    }
    text
}

/// Laws that take a minute and more each: their own command measures them.
const LONG_LAWS: [&str; 6] = [
    "cantilever",
    "resolution",
    "swing",
    "vibration",
    "flight",
    "corner",
];

fn laws(watcher: &mut dyn Watcher) -> Result<Content, LabError> {
    let names = LAWS.iter().map(|law| law.name.to_owned());
    let names: Vec<String> = names
        .filter(|name| !LONG_LAWS.contains(&name.as_str()))
        .collect();
    Ok(law_table(&validate(&names, watcher)?).into())
}

fn stability(watcher: &mut dyn Watcher) -> Result<Content, LabError> {
    let cells = stability_map(watcher)?;
    let limits = limits(watcher)?;
    let hard = hard_cases(watcher)?;
    Ok(Content {
        tables: stability_table(&limits, &hard),
        charts: stability_files(&cells, &limits, &hard)?,
    })
}

fn speed_against_accuracy(watcher: &mut dyn Watcher) -> Result<Content, LabError> {
    let data = chart(&[], ChartPlan::QUICK, watcher)?;
    Ok(Content {
        tables: when_to_use(&data),
        charts: chart_files(&data)?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_session::Silent;

    fn found(name: &'static str) -> Measured {
        Measured {
            name,
            text: format!("## {name}\n\nnew"),
            charts: Vec::new(),
            wall_s: 1.0,
            cpu_s: 1.0,
        }
    }

    const DOCUMENT: &str = "# Page\n\nby hand\n\n<!-- measured -->\nold head\n<!-- /measured -->\n\n\
                            <!-- laws -->\nold laws\n<!-- /laws -->\n\n<!-- drag -->\nold drag\n<!-- /drag -->\n\n## Known\n\nby hand too\n";

    #[test]
    fn one_section_is_replaced_with_its_own_provenance_and_the_rest_stays() {
        let written = page(DOCUMENT, &[found("laws")], "Commit `abc`.");
        let expected = DOCUMENT.replace("old laws", "## laws\n\nnew\n\nCommit `abc`.");
        assert_eq!(written, expected);
    }

    #[test]
    fn all_sections_together_have_one_head_and_what_is_written_by_hand_stays() {
        let all: Vec<Measured> = SECTIONS.iter().map(|section| found(section.name)).collect();
        let written = page(DOCUMENT, &all, "Commit `abc`.");
        for text in [
            "# Page\n\nby hand\n\n<!-- measured -->\nCommit `abc`.\n<!-- /measured -->\n",
            "<!-- laws -->\n## laws\n\nnew\n<!-- /laws -->\n",
            "## Known\n\nby hand too\n",
            "<!-- markers -->\n## markers\n\nnew\n<!-- /markers -->\n",
        ] {
            assert!(written.contains(text), "{text:?} in\n{written}");
        }
        assert!(!written.contains("old"), "{written}");
        assert_eq!(page(&written, &all, "Commit `abc`."), written);
    }

    #[test]
    fn laws_that_are_left_out_exist_and_are_named_with_their_command() {
        let laws = &SECTIONS[0];
        let command = format!("`toile validate {}`", LONG_LAWS.join(" "));
        assert!(laws.claim.contains(&command), "{}", laws.claim);
        let names = LONG_LAWS.map(str::to_owned);
        assert_eq!(crate::laws_named(&names).unwrap().len(), LONG_LAWS.len());
    }

    #[test]
    fn an_unknown_section_is_refused_with_the_names_there_are() {
        let names = ["laws".to_owned(), "moon".to_owned()];
        let error = sections_named(&names).err().unwrap().to_string();
        assert!(
            error.contains("\"moon\"") && error.contains("laws, stability"),
            "{error}"
        );
        assert_eq!(sections_named(&names[..1]).unwrap().len(), 1);
        assert_eq!(sections_named(&[]).unwrap().len(), SECTIONS.len());
    }

    #[test]
    fn the_section_of_meshes_has_a_row_for_each_pattern_that_ships() {
        let section = sections_named(&["meshes".to_owned()]).unwrap()[0];
        let measured = section.measure(&mut Silent).unwrap();
        for (_, name) in toile_session::SAMPLES {
            let row = format!("\n| {name} | ");
            assert!(measured.text.contains(&row), "{}", measured.text);
        }
        assert!(
            measured.text.starts_with("## Meshes\n\n"),
            "{}",
            measured.text
        );
        assert!(!measured.text.contains("failed"), "{}", measured.text);
        assert!(measured.wall_s > 0.0 && measured.charts.is_empty());
    }
}
