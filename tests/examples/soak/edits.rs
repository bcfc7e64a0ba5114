//! Edits of a pattern under the garment that hangs, one after the other, beside drapes from the start.

use toile_session::Quality;
use toile_tests::edits::{Ends, Hung, Trial, draped};
use toile_tests::random::Random;

/// Drapes from starts micrometres apart that each end is held to.
const FRESH: u64 = 8;
/// By how much their range is widened on both sides (m).
const WIDENED: f64 = 1e-3;

/// Edits of a millimetre and of five, as many as asked of each, on the T-shirt; `--plain` leaves the drapes from
/// the start out.
pub fn edits(arguments: &[String]) -> Result<(), String> {
    let mut count = 10;
    let mut quality = Quality::Fit;
    let mut compares = true;
    let mut rest = arguments.iter();
    while let Some(argument) = rest.next() {
        match argument.as_str() {
            "--plain" => compares = false,
            "--quality" => quality = super::quality_named(rest.next())?,
            number => {
                let given = number.parse();
                count = given.map_err(|_| format!("{number} is no count of edits"))?;
            }
        }
    }
    let mut hung = Hung::new("t-shirt.toile.json", quality)?;
    println!(
        "a drape from the start: {:.2} s of processor time",
        hung.fresh_cpu
    );
    println!(
        "mm,taking_s,prediction_s,correction_s,residual_before,residual_predicted,residual_end,share,at_rest,crossings,structures,same_topology,hem,girth,within"
    );
    let mut failed = Vec::new();
    let mut random = Random(36);
    for size in [1e-3, 5e-3] {
        let mut trials = Vec::new();
        for number in 0..count {
            let trial = hung.edit(&mut random, size)?;
            let within = match compares {
                true => Some(is_within(&mut hung, &trial.ends)?),
                false => None,
            };
            println!("{}", row(size, &trial, within));
            if trial.crossings > 0 || !trial.at_rest || within == Some(false) {
                failed.push(format!("edit {number} of {:.0} mm", 1e3 * size));
            }
            trials.push(trial);
        }
        sum_up(size, hung.fresh_cpu, &trials);
    }
    match failed.is_empty() {
        true => Ok(()),
        false => Err(failed.join(", ")),
    }
}

fn is_within(hung: &mut Hung, ends: &Ends) -> Result<bool, String> {
    let mut fresh = Vec::new();
    for seed in 0..FRESH {
        let run = draped(hung.fresh_setup(seed)?)?;
        fresh.push(Ends::of(&run.system.mesh(&run.state.positions)));
    }
    let holds = |of: fn(&Ends) -> f64| {
        let all = fresh.iter().map(of);
        let low = all.clone().fold(f64::INFINITY, f64::min) - WIDENED;
        let high = all.fold(f64::NEG_INFINITY, f64::max) + WIDENED;
        (low..=high).contains(&of(ends))
    };
    Ok(holds(|ends| ends.hem) && holds(|ends| ends.girth))
}

fn row(size: f64, trial: &Trial, within: Option<bool>) -> String {
    let [before, predicted, end] = trial.residuals;
    format!(
        "{:.0},{:.3},{:.3},{:.2},{before:.2e},{predicted:.2e},{end:.2e},{:.2},{},{},{},{},{:.4},{:.4},{}",
        1e3 * size,
        trial.taking_cpu,
        trial.prediction_cpu,
        trial.correction_cpu,
        trial.share,
        trial.at_rest,
        trial.crossings,
        trial.structures,
        trial.shares_topology,
        trial.ends.hem,
        trial.ends.girth,
        within.map_or("-".to_owned(), |within| within.to_string()),
    )
}

fn sum_up(size: f64, fresh: f64, trials: &[Trial]) {
    let median = |of: fn(&Trial) -> f64| {
        let mut all: Vec<f64> = trials.iter().map(of).collect();
        all.sort_by(f64::total_cmp);
        all.get(all.len() / 2).copied().unwrap_or(f64::NAN)
    };
    let halved = trials
        .iter()
        .filter(|t| t.residuals[1] <= 0.5 * t.residuals[0]);
    println!(
        "{:.0} mm: taking 1/{:.0} of a drape from the start at the median, predicting 1/{:.0}, going on to rest {:.2}; residual halved by {} of {} predictions",
        1e3 * size,
        fresh / median(|t| t.taking_cpu),
        fresh / median(|t| t.prediction_cpu),
        median(|t| t.correction_cpu) / fresh,
        halved.count(),
        trials.len(),
    );
}
