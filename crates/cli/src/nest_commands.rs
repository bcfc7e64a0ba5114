//! Runs `toile nest`: pieces laid on fabric.

use crate::bar::Bar;
use crate::nest_arguments::Nest;
use crate::output::{Failure, Output, count};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use toile_geometry::{Duration, Length};
use toile_session::{
    Budget, ClothSettings, Event, MarkerJob, MarkerSettings, MarkerSummary, NestOptions, Shown,
    Start, is_nesting_instance, nest_instance, nest_marker, nest_patterns, open_marker,
    open_marker_settings, rule_table, study_rules,
};

/// What the arguments ask for.
fn nest_options(nest: &Nest) -> Result<NestOptions, Failure> {
    let metres = |length: &Option<Length>| length.map(|l| l.as_metres());
    let seconds = nest.time.map(Duration::as_seconds);
    if let Some(seconds) = seconds.filter(|&t| t <= 0.0) {
        return Err(Failure::bad_input(format!(
            "--time is {seconds} s; give a time above 0, as in 10s"
        )));
    }
    Ok(NestOptions {
        sizes: nest.size.clone().unwrap_or_default(),
        cloth: ClothSettings {
            width: metres(&nest.width),
            length: metres(&nest.length),
            selvedge: metres(&nest.selvedge),
            end_margin: metres(&nest.end_margin),
            gap: metres(&nest.gap),
            nap: nest.nap,
            tilt: nest.tilt.map(f64::to_radians),
            spread: nest.spread,
            plies: nest.plies,
            price_per_metre: price(nest.price)?,
            print: nest.repeat,
            rolls: (!nest.roll.is_empty()).then(|| nest.roll.clone()),
            ..ClothSettings::default()
        },
        flaws: nest.defect.clone(),
        settings: match &nest.settings {
            Some(path) => open_marker_settings(path)?,
            None => MarkerSettings::default(),
        },
        marker: None,
        from: nest
            .from
            .iter()
            .map(|path| open_marker(path))
            .collect::<Result<_, _>>()?,
        locked: nest.lock.clone(),
        keep_best: true,
        formats: nest.write.iter().map(|&f| f.into()).collect(),
        budget: match seconds {
            Some(seconds) => Budget::Seconds(seconds),
            None => Budget::Evaluations(nest.evaluations),
        },
        seed: nest.seed,
        islands: nest.islands,
        threads: nest.threads,
    })
}

/// A price of 0 or more.
fn price(given: Option<f64>) -> Result<Option<f64>, Failure> {
    match given {
        Some(price) if !(price.is_finite() && price >= 0.0) => Err(Failure::bad_input(format!(
            "--price is {price}; give 0 or more"
        ))),
        price => Ok(price),
    }
}

/// The solution of a nesting instance.
fn solve(
    path: &Path,
    nest: &Nest,
    options: &NestOptions,
    output: &Output,
) -> Result<Value, Failure> {
    let (summary, notes, file) =
        nest_instance(path, options, (&nest.out, &mut Bar::stopped_by_a_signal()))
            .map_err(|error| Failure::from(error).about(path))?;
    for note in &notes {
        output.warn(format!("note: {note}"));
    }
    output.say(format!(
        "{} laid on a strip of {:.4} by {:.4}, density {:.3} %",
        count(summary.pieces, "item"),
        summary.length,
        summary.width,
        summary.efficiency * 100.0
    ));
    output.say(format!("wrote {}", file.display()));
    Ok(json!({
        "files": [file],
        "instance": summary.fabric,
        "pieces": summary.pieces,
        "unplaced": summary.unplaced,
        "strip_width": summary.length,
        "strip_height": summary.width,
        "density": summary.efficiency,
        "sound": summary.sound,
    }))
}

/// A marker of the only pattern: searched for and stored in its file, or as it is stored.
fn marker_of_file(
    nest: &Nest,
    (name, options): (&str, &NestOptions),
) -> Result<(Vec<MarkerSummary>, Vec<PathBuf>), Failure> {
    let [path] = &nest.patterns[..] else {
        let message = "--marker names a marker of one pattern; give that pattern alone";
        return Err(Failure::bad_input(message));
    };
    let start = match nest.as_it_lies {
        true => Start::AsItLies,
        false => Start::Anew,
    };
    let job = MarkerJob {
        name: name.to_owned(),
        search: (!nest.stored).then(|| (start, options.search())),
        formats: options.formats.clone(),
    };
    let bar = &mut Bar::stopped_by_a_signal();
    let made = nest_marker(path, &job, (&nest.out, bar));
    made.map_err(|error| Failure::from(error).about(path))
}

/// Pieces laid on fabric.
pub fn nest(nest: &Nest, output: &Output) -> Result<Value, Failure> {
    let options = nest_options(nest)?;
    if let [path] = &nest.patterns[..]
        && is_nesting_instance(path)
    {
        if nest.study {
            let message = "--study lays patterns; an instance has no rules of the trade";
            return Err(Failure::bad_input(message).about(path));
        }
        return solve(path, nest, &options, output);
    }
    if nest.study {
        return study(nest, &options, output);
    }
    let (summaries, paths) = match &nest.marker {
        Some(name) => marker_of_file(nest, (name, &options))?,
        None => nest_patterns(
            &nest.patterns,
            &options,
            (&nest.out, &mut Bar::stopped_by_a_signal()),
        )?,
    };
    let listed: Vec<Value> = summaries
        .iter()
        .map(|summary| {
            json!({
                "fabric": summary.fabric,
                "roll": summary.roll,
                "pieces": summary.pieces,
                "unplaced": summary.unplaced,
                "missing": summary.missing.iter().map(|[name, reason]| {
                    json!({ "name": name, "reason": reason })
                }).collect::<Vec<_>>(),
                "width_m": summary.width,
                "length_m": summary.length,
                "plies": summary.plies,
                "fabric_needed_m": summary.yardage,
                "cost": summary.cost,
                "currency": summary.currency,
                "efficiency": summary.efficiency,
                "utilisation": summary.utilisation,
                "notes": summary.notes,
                "sound": summary.sound,
            })
        })
        .collect();
    let report = json!({ "files": paths, "markers": listed });
    for summary in &summaries {
        output.print_events(&[Event::Nested(summary.clone())]);
        for note in &summary.notes {
            output.say(format!("note: {note}"));
        }
        for [name, reason] in &summary.missing {
            output.warn(format!("not laid: {name}: {reason}"));
        }
    }
    yardage(&summaries, output);
    output.print_events(&[Event::FilesWritten { paths }]);
    Ok(report)
}

/// What is needed of each fabric, and what it costs.
fn yardage(summaries: &[MarkerSummary], output: &Output) {
    let mut fabrics: Vec<&str> = Vec::new();
    for summary in summaries {
        if !fabrics.contains(&summary.fabric.as_str()) {
            fabrics.push(&summary.fabric);
        }
    }
    for fabric in fabrics {
        let own = || summaries.iter().filter(|l| l.fabric == fabric);
        let length: f64 = own().map(|l| l.yardage).sum();
        let cost: Option<f64> = own().map(|l| l.cost).sum();
        let unit = own().next().map(|l| l.unit).unwrap_or_default();
        let [first, other] = Shown(unit).cloth(length);
        let currency = own().next().map_or("", |l| l.currency.as_str());
        let cost = cost.map_or_else(String::new, |c| format!(", cost {c:.2} {currency}"));
        output.say(format!(
            "{fabric}: {first} of fabric ({other}){}",
            cost.trim_end()
        ));
    }
}

/// What each rule of the trade costs.
fn study(nest: &Nest, options: &NestOptions, output: &Output) -> Result<Value, Failure> {
    let rows = study_rules(&nest.patterns, options, (nest.seeds, &mut Bar::new()))?;
    output.say(rule_table(&rows, options.budget).trim_end());
    let listed = rows.iter().map(|row| {
        json!({
            "rule": row.rule,
            "fabric_m": row.fabric,
            "efficiency": row.efficiency,
            "cost": row.cost,
            "unplaced": row.unplaced,
            "refused": row.refused,
        })
    });
    Ok(json!({ "rules": listed.collect::<Vec<_>>() }))
}
