//! Runs `toile print`: pieces on paper.

use crate::bar::Bar;
use crate::output::{Failure, Output, count};
use crate::print_arguments::Print;
use serde_json::{Value, json};
use toile_session::{CutList, Printed, Project, Shown, print_pattern};

/// Pieces on paper.
pub fn print(print: &Print, output: &Output) -> Result<Value, Failure> {
    let options = print.options();
    let printed = Project::open(&print.pattern)
        .and_then(|(project, notes)| {
            let bar = &mut Bar::stopped_by_a_signal();
            let mut printed = print_pattern((&project, &print.out), &options, bar)?;
            printed.notes.splice(0..0, notes);
            Ok(printed)
        })
        .map_err(|error| Failure::from(error).about(&print.pattern))?;
    for note in &printed.notes {
        output.warn(format!("note: {note}"));
    }
    let [rows, columns] = extent(&printed);
    output.say(match options.paper.sheet() {
        Some(_) => format!(
            "{} on {} of {}, {} and {}",
            count(printed.pieces.len(), "piece"),
            count(printed.tiles.len(), "sheet"),
            options.paper.name(),
            count(rows as usize, "row"),
            count(columns as usize, "column"),
        ),
        None => {
            let size = printed.tiles.first().map(|tile| tile.sheet);
            let size = size.unwrap_or_default();
            format!(
                "{} on one page of {} x {}",
                count(printed.pieces.len(), "piece"),
                printed.shown.length(size.x).trim_end_matches(" cm"),
                printed.shown.length(size.y)
            )
        }
    });
    // Of several sizes, what is cut is told of the first.
    let size = match &printed.sizes[..] {
        [first, _, ..] => format!(" in size {first}"),
        _ => String::new(),
    };
    for list in &printed.cut_list {
        output.say(cut_words(list, (&size, printed.shown)));
    }
    output.say(format!("wrote {}", print.out.display()));
    Ok(json!({
        "files": [print.out],
        "paper": options.paper.name(),
        "scale": options.scale,
        "sizes": printed.sizes,
        "pieces": printed.pieces,
        "sheets": printed.tiles.len(),
        "rows": rows,
        "columns": columns,
        "sheet_mm": printed.tiles.first().map(|tile| [tile.sheet.x * 1e3, tile.sheet.y * 1e3]),
        "cut_list": printed.cut_list.iter().map(cut_json).collect::<Vec<_>>(),
        "notes": printed.notes,
    }))
}

/// Rows and columns of sheets.
fn extent(printed: &Printed) -> [u32; 2] {
    [0, 1].map(|axis| {
        let places = printed.tiles.iter().map(|tile| tile.place[axis]);
        places.max().unwrap_or_default()
    })
}

fn cut_words(list: &CutList, (size, shown): (&str, Shown)) -> String {
    let pieces = list.pieces.iter().map(|piece| match piece.pairs {
        0 => format!("{} x {}", piece.quantity, piece.name),
        1 if piece.quantity == 2 => format!("1 pair of {}", piece.name),
        n if 2 * n == piece.quantity => format!("{n} pairs of {}", piece.name),
        _ => format!("{} x {}, in pairs", piece.quantity, piece.name),
    });
    let pieces: Vec<String> = pieces.collect();
    format!(
        "cut from {}{size}: {} ({})",
        list.fabric,
        pieces.join(", "),
        shown.area(list.area())
    )
}

fn cut_json(list: &CutList) -> Value {
    let pieces = list.pieces.iter().map(|piece| {
        json!({
            "name": piece.name,
            "quantity": piece.quantity,
            "pairs": piece.pairs,
            "area_cm2": piece.area * 1e4,
        })
    });
    json!({
        "fabric": list.fabric,
        "area_cm2": list.area() * 1e4,
        "pieces": pieces.collect::<Vec<_>>(),
    })
}
