//! Writes markers as files, in every requested format.

use crate::{FinishedMarker, MarkerError};
use toile_interchange::{
    FormatError, write_jagua_instance, write_marker_dxf, write_marker_hpgl, write_marker_json,
    write_marker_pdf, write_marker_report, write_marker_svg,
};

/// A file format of markers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MarkerFormat {
    /// `marker.svg`: a drawing at true size.
    Svg,
    /// `marker.json`: the marker as data.
    Json,
    /// `marker.dxf`: release 12, millimetres.
    Dxf,
    /// `marker.pdf`: one page at true size.
    Pdf,
    /// `marker-report.pdf`: A4, all markers.
    Report,
    /// `marker.plt`: HPGL/2.
    Hpgl,
    /// `marker-instance.json`: the pieces and the usable width as a nesting instance for other programs.
    Instance,
}

/// The files of markers: `marker.svg`, `marker.json` and the other requested formats, numbered from the
/// second marker on. Returns for each marker the properties that a format could not hold.
///
/// # Errors
/// A marker that a format cannot hold.
pub fn marker_files(
    (name, formats): (&str, &[MarkerFormat]),
    finished_markers: &[FinishedMarker],
    files: &mut Vec<(String, Vec<u8>)>,
) -> Result<Vec<Vec<String>>, MarkerError> {
    let mut lost = vec![Vec::new(); finished_markers.len()];
    // The other formats store characters as codes, and the reader's fonts draw them.
    let drawn = [MarkerFormat::Pdf, MarkerFormat::Hpgl, MarkerFormat::Report];
    let draws_letters = formats.iter().any(|format| drawn.contains(format));
    for (k, finished) in finished_markers.iter().enumerate() {
        let stem = match k {
            0 => "marker".to_owned(),
            k => format!("marker-{}", k + 1),
        };
        let drawing = finished.drawing(name);
        if draws_letters {
            lost[k].extend(drawing.missing_note());
        }
        for format in formats {
            let (ending, bytes) = match format {
                MarkerFormat::Svg => ("svg", write_marker_svg(&drawing).map(String::into_bytes)),
                MarkerFormat::Json => {
                    let text = write_marker_json(&finished.file(name));
                    ("json", text.map(String::into_bytes))
                }
                MarkerFormat::Dxf => ("dxf", write_marker_dxf(&drawing).map(String::into_bytes)),
                MarkerFormat::Hpgl => ("plt", write_marker_hpgl(&drawing).map(String::into_bytes)),
                MarkerFormat::Pdf => ("pdf", write_marker_pdf(&drawing)),
                MarkerFormat::Instance => {
                    let (text, left_out) =
                        write_jagua_instance(name, &finished.items, &finished.strip)
                            .map_err(cannot("marker-instance.json"))?;
                    let file = format!("{stem}-instance.json");
                    if !left_out.is_empty() {
                        let left_out = left_out.join(", ");
                        lost[k].push(format!("{file} does not hold: {left_out}"));
                    }
                    files.push((file, text.into_bytes()));
                    continue;
                }
                MarkerFormat::Report => continue,
            };
            files.push((
                format!("{stem}.{ending}"),
                bytes.map_err(cannot("the marker"))?,
            ));
        }
    }
    if formats.contains(&MarkerFormat::Report) {
        let drawing_of = |(finished, lost): (&FinishedMarker, &Vec<String>)| {
            let mut drawing = finished.drawing(name);
            drawing.facts.notes.extend(lost.iter().cloned());
            drawing
        };
        let drawings: Vec<_> = finished_markers.iter().zip(&lost).map(drawing_of).collect();
        let report = write_marker_report(name, &drawings).map_err(cannot("marker-report.pdf"))?;
        files.push(("marker-report.pdf".to_owned(), report));
    }
    Ok(lost)
}

fn cannot(file: &'static str) -> impl Fn(FormatError) -> MarkerError {
    move |error| MarkerError::Write { file, error }
}
