//! Runs `toile convert`.

use crate::convert_arguments::Convert;
use crate::output::{Failure, Output};
use serde_json::{Value, json};
use toile_session::{
    Choice, ConvertOptions, Converted, Loss, SizeSelection, WrittenPattern, convert as convert_file,
};

/// A pattern in another format, with what was guessed in reading and lost in writing.
pub fn convert(convert: &Convert, output: &Output) -> Result<Value, Failure> {
    let options = ConvertOptions {
        open: convert.read.options(),
        to: convert.to,
        origin: convert.origin,
        sizes: match convert.all_sizes {
            true => Some(SizeSelection::All),
            false => convert.size.clone(),
        },
    };
    let Converted {
        read,
        notes,
        written:
            WrittenPattern {
                files,
                format,
                losses,
            },
    } = convert_file(&convert.input, &convert.output, &options)
        .map_err(|error| Failure::from(error).about(&convert.input))?;
    for note in &notes {
        output.say(format!("note: {note}"));
    }
    for loss in &losses {
        let remedy = match loss.why == Loss::NOT_ASKED_FOR {
            true => "; --all-sizes writes them",
            false => "",
        };
        output.say(format!("not carried over: {loss}{remedy}"));
    }
    for file in &files {
        output.say(format!("wrote {}", file.display()));
    }
    Ok(json!({
        "files": files,
        "read_as": read.format.word(),
        "written_as": format.word(),
        "guesses": read.guesses,
        "lost_in_reading": read.losses,
        "lost": losses,
        "notes": notes,
    }))
}
