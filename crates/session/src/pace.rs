//! Pace of the run of a scene: progress in words, the time left, the slow-down, and whether the run is given
//! up. Nothing but the choice to give up influences results.

use crate::{RunOptions, SessionError, cpu_seconds};
use std::collections::VecDeque;
use std::time::Instant;
use toile_drape::{Aspect, Finding, SceneRun};

/// Measures the pace of a run.
pub(crate) struct Pace {
    /// Most processor time that a simulated second may take (s).
    give_up: Option<f64>,
    start: Instant,
    /// Moments of the last simulated second, the oldest first.
    past: VecDeque<Moment>,
    /// Least wall time that a simulated second has taken so far (s).
    fastest: f64,
}

/// Times of a run at one moment.
#[derive(Clone, Copy)]
struct Moment {
    /// Simulated time (s).
    time: f64,
    /// Wall time (s).
    wall: f64,
    /// Processor time (s), where the system tells it.
    processor: Option<f64>,
}

/// Simulated time over which the processor time of a second is measured (s).
const SPAN: f64 = 1.0;
/// Share of the scene's duration over which the present speed is measured (1).
const RECENT: f64 = 0.1;
/// Largest number of moments kept in a span: a moment that follows the last one more closely is not kept.
const MAX_MOMENTS: f64 = 1000.0;
/// Time of a simulated second over that of the fastest one, above which the slow-down is reported (1).
const SLOW: f64 = 2.0;

impl Pace {
    /// Begins at the present state of a run.
    ///
    /// # Errors
    /// A limit of processor time that is not positive, or that is given for a run to rest, which has no
    /// simulated seconds, or on a system that tells no processor time.
    pub fn new(options: &RunOptions, run: &SceneRun) -> Result<Self, SessionError> {
        if let Some(value) = options.give_up {
            let refuse = |hint| {
                let what = "the processor time of a simulated second after which a run is given up";
                Err(SessionError::Number { what, value, hint })
            };
            if !(value.is_finite() && value > 0.0) {
                return refuse("give a time above zero, as in 10s or 2min");
            }
            if run.settings().method.kind.is_equilibrium() {
                return refuse("a run to rest has no simulated seconds: give method.iterations");
            }
            if cpu_seconds().is_none() {
                return refuse("this system tells no processor time: leave it out");
            }
        }
        let mut pace = Self {
            give_up: options.give_up,
            start: Instant::now(),
            past: VecDeque::new(),
            fastest: f64::INFINITY,
        };
        pace.past.push_back(pace.moment(run));
        Ok(pace)
    }

    /// Whether there is a limit of processor time at which the run is given up.
    pub fn may_give_up(&self) -> bool {
        self.give_up.is_some()
    }

    fn moment(&self, run: &SceneRun) -> Moment {
        Moment {
            time: run.state.time,
            wall: self.start.elapsed().as_secs_f64(),
            processor: self.give_up.and_then(|_| cpu_seconds()),
        }
    }

    /// Takes note of a step. Returns a finding if the run is to be given up: its last simulated second, or
    /// the part of it so far, has taken more processor time than the limit.
    pub fn follow(&mut self, run: &SceneRun) -> Option<Finding> {
        let now = self.moment(run);
        while self.past.len() > 1 && self.past[1].time <= now.time - SPAN {
            self.past.pop_front();
        }
        let newest = self.past.back().map_or(f64::NEG_INFINITY, |m| m.time);
        if now.time - newest >= SPAN / MAX_MOMENTS {
            self.past.push_back(now);
        }
        let limit = self.give_up?;
        let then = self.past.front()?;
        let taken = now.processor? - then.processor?;
        (taken > limit).then(|| {
            let words = format!(
                "it was given up at {:.3} of {:.3} s: it slowed down until a simulated second took more than the {limit} s of processor time allowed",
                now.time,
                run.settings().duration
            );
            Finding::bad(Aspect::Pace, words)
        })
    }

    /// Progress in words, with the time left and the slow-down where they are known.
    pub fn words(&mut self, run: &SceneRun) -> String {
        let settings = run.settings();
        if settings.method.kind.is_equilibrium() {
            let force = run.residual().filter(|force| force.is_finite());
            let force = force.map_or_else(String::new, |f| format!(", net force {f:.1e}"));
            return format!("step {}{force}", run.steps());
        }
        let now = self.moment(run);
        let mut words = format!("{:.2} of {:.2} s", now.time, settings.duration);
        let recent = now.time - SPAN.min(RECENT * settings.whole());
        let then = self.past.iter().rev().find(|then| then.time <= recent);
        let Some(then) = then.or(self.past.front()) else {
            return words;
        };
        let rate = (now.wall - then.wall) / (now.time - then.time);
        if rate.is_finite() {
            let left = rate * (settings.duration - now.time).max(0.0);
            words.push_str(&format!(", {} left", spelt(left)));
            if then.time <= recent {
                self.fastest = self.fastest.min(rate);
            }
            if rate > SLOW * self.fastest {
                let times = rate / self.fastest;
                words.push_str(&format!(
                    ", slowed {times:.0} times to {} for a simulated second",
                    spelt(rate)
                ));
            }
        }
        words
    }
}

/// A time (s) in the units that a person would use.
fn spelt(seconds: f64) -> String {
    let whole = seconds.round() as u64;
    match whole {
        0 => "under 1 s".to_owned(),
        1..60 => format!("{whole} s"),
        60..3600 => format!("{} min {} s", whole / 60, whole % 60),
        _ => format!("{} h {} min", whole / 3600, whole % 3600 / 60),
    }
}

#[cfg(test)]
mod tests {
    use super::spelt;

    #[test]
    fn times_are_spelt_in_the_units_of_a_person() {
        let told = [0.2, 59.4, 61.0, 3600.0 * 7.5].map(spelt);
        assert_eq!(told, ["under 1 s", "59 s", "1 min 1 s", "7 h 30 min"]);
    }
}
