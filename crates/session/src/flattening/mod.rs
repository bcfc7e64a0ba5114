//! A surface flattened to a panel: pattern, report and strain map.
//!
//! # Decided with
//! - [`toile_flatten::flatten`], [`toile_flatten::flatten_surface`]: the shape of least energy, darts; of a whole mesh, of a
//!   region of one;
//! - [`crate::flattening`] (`surface.rs`, `loop_file.rs`, `skin_loop.rs`): meshes and bodies; places on them, of a file and
//!   clicked;
//! - [`crate::flattening`] (`panel.rs`): the panel as a document;
//! - [`crate::mesh_file`], [`crate::fabrics`]: meshes and fabrics of files.

mod flat_surface;
mod loop_file;
mod panel;
mod report;
mod skin_loop;
mod strain_map;
mod surface;

use crate::SessionError;
use crate::output::cannot;
use crate::product::body_obj;
use crate::tools::check_ending;
use flat_surface::{Target, check_ease, format_error};
use loop_file::open_loop;
use std::path::Path;
use strain_map::strain_map;
use toile_interchange::{write_all_atomically, write_document, write_obj};

pub use flat_surface::FlatSurface;
pub use report::{DartReport, FlattenOptions, FlattenReport};
pub use skin_loop::SkinLoop;
pub use surface::SurfaceSource;

/// Flattens a surface, or the region of it within a loop, to a panel, and writes it as a pattern, with a report and a
/// strain map beside it; of a region the surface, too.
///
/// # Errors
/// The surface or the loop cannot be read, the region is no disk, a number or the fabric cannot be used, or a file cannot be
/// written.
pub fn flatten_to_panel(
    source: &SurfaceSource,
    options: &FlattenOptions,
    to: &Path,
) -> Result<FlattenReport, SessionError> {
    check_ending(
        to,
        &[".toile.json"],
        "a panel is written as a pattern, NAME.toile.json",
    )?;
    check_ease(options.ease)?;
    let opened = source.open()?;
    let mut notes = opened.notes.clone();
    let name = to.file_name().unwrap_or_default().to_string_lossy();
    let stem = name[..name.len() - ".toile.json".len()].to_owned();
    let (target, place) = match &options.loop_file {
        None => (Target::whole(&opened.mesh, options.ease), source.place()),
        Some(path) => {
            let (asked, found) = open_loop(path, opened.mannequin.as_ref())?;
            notes.extend(found);
            let surface = (&opened.mesh, opened.mannequin.is_some());
            let region = Target::inside(surface, &asked, options, &mut notes)
                .map_err(|words| format_error(path, "the loop", &words))?;
            (region, path.clone())
        }
    };
    let panel_name = if stem.is_empty() { "panel" } else { &stem };
    let surface = FlatSurface::of(&target, (&place, panel_name), (options, notes))?;
    let folder = to.parent().unwrap_or(Path::new("")).to_owned();
    let mut names = vec![
        name.clone().into_owned(),
        format!("{stem}-flatten.json"),
        format!("{stem}-strain.png"),
    ];
    let is_region = matches!(target, Target::Region(..));
    if is_region {
        names.push(format!("{stem}-surface.obj"));
    }
    let mut report = surface.report;
    report.files = names.iter().map(|name| folder.join(name)).collect();
    let document =
        write_document(&surface.pattern, &Default::default()).map_err(cannot("the pattern"))?;
    let words = report.to_json().map_err(cannot("the report"))?;
    let mut contents = vec![
        document.into_bytes(),
        words.into_bytes(),
        strain_map(&surface.flat, options.strain)?,
    ];
    if is_region {
        let mesh = surface.flat.region.mesh();
        let obj = write_obj(&body_obj(mesh)).map_err(cannot("the surface"))?;
        contents.push(obj.into_bytes());
    }
    let files: Vec<(String, Vec<u8>)> = names.into_iter().zip(contents).collect();
    write_all_atomically(&folder, &files)?;
    Ok(report)
}
