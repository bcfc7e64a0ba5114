//! Predicts missing measurements by regression on the given ones.

use crate::survey::{COUNT, MEN, NAMES, Survey, WOMEN};
use crate::{Measurements, Origin};

/// The statistics and averages that a prediction uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Build {
    /// Adult women.
    Woman,
    /// Adult men.
    Man,
    /// The mean of both.
    Either,
    /// A child of an age (years), where no stature is given.
    Child(u8),
}

/// Statistics of one build in SI units.
struct Statistics {
    mean: [f64; COUNT],
    deviation: [f64; COUNT],
    correlation: Vec<[f64; COUNT]>,
}

impl Statistics {
    fn of(build: Build) -> Self {
        match build {
            Build::Woman => Self::mixed(&[&WOMEN]),
            Build::Man => Self::mixed(&[&MEN]),
            Build::Either | Build::Child(_) => Self::mixed(&[&WOMEN, &MEN]),
        }
    }

    /// Mean of the means, deviations and correlations within each sex.
    fn mixed(surveys: &[&Survey]) -> Self {
        let share = 1.0 / surveys.len() as f64;
        let mut result = Self {
            mean: [0.0; COUNT],
            deviation: [0.0; COUNT],
            correlation: vec![[0.0; COUNT]; COUNT],
        };
        for survey in surveys {
            let mut below = survey.correlation.iter();
            for i in 0..COUNT {
                result.mean[i] += share * f64::from(survey.mean[i]) * 1e-4;
                result.deviation[i] += share * f64::from(survey.deviation[i]) * 1e-4;
                result.correlation[i][i] = 1.0;
                for j in 0..i {
                    let value = below.next().map_or(0.0, |&r| f64::from(r) * 1e-4);
                    result.correlation[i][j] += share * value;
                    result.correlation[j][i] += share * value;
                }
            }
        }
        result
    }

    /// Mean of all given some of them, each with the deviation (m) of the error it was observed
    /// with: `mu + C_ao (C_oo + N)^-1 (x_o - mu_o)`, the conditional mean of a normal
    /// distribution (Anderson 1958).
    fn given(&self, seen: &[(usize, f64, f64)]) -> [f64; COUNT] {
        let mut matrix: Vec<Vec<f64>> = seen
            .iter()
            .map(|&(i, _, _)| {
                seen.iter()
                    .map(|&(j, _, _)| self.correlation[i][j])
                    .collect()
            })
            .collect();
        let mut right: Vec<f64> = Vec::new();
        for (row, &(i, value, noise)) in seen.iter().enumerate() {
            // The published digits of the correlations bear no smaller error.
            matrix[row][row] += (noise / self.deviation[i]).powi(2) + 1e-4;
            right.push((value - self.mean[i]) / self.deviation[i]);
        }
        solve(&mut matrix, &mut right);
        let mut result = self.mean;
        for (a, value) in result.iter_mut().enumerate() {
            let shift: f64 = seen
                .iter()
                .zip(&right)
                .map(|(&(i, _, _), &weight)| self.correlation[a][i] * weight)
                .sum();
            *value += self.deviation[a] * shift;
        }
        result
    }
}

/// Solves a symmetric positive definite system in place by Cholesky's method.
fn solve(matrix: &mut [Vec<f64>], right: &mut [f64]) {
    let n = right.len();
    for j in 0..n {
        for k in 0..j {
            for i in j..n {
                matrix[i][j] -= matrix[i][k] * matrix[j][k];
            }
        }
        let root = matrix[j][j].max(1e-12).sqrt();
        for row in matrix.iter_mut().skip(j) {
            row[j] /= root;
        }
    }
    for i in 0..n {
        for k in 0..i {
            right[i] -= matrix[i][k] * right[k];
        }
        right[i] /= matrix[i][i];
    }
    for i in (0..n).rev() {
        for k in i + 1..n {
            right[i] -= matrix[k][i] * right[k];
        }
        right[i] /= matrix[i][i];
    }
}

fn place(name: &str) -> Option<usize> {
    NAMES.iter().position(|&known| known == name)
}

/// Sizes within this ratio of an average adult are the statistics' own; beyond it a body is
/// predicted as an adult of the nearest size, scaled.
const SPAN: [f64; 2] = [0.8, 1.25];

/// Measurements that others are predicted from, although the average bodies are without them.
const FURTHER_OBSERVATIONS: [&str; 4] = [
    "waist_height",
    "outside_leg",
    "hps_to_waist_back",
    "waist_to_crotch",
];

impl Measurements {
    /// The average of a build.
    pub fn average(build: Build) -> Self {
        match build {
            Build::Woman => Self::adult_woman(),
            Build::Man => Self::adult_man(),
            Build::Either => Self::adult(),
            Build::Child(age) => Self::child(age),
        }
    }

    /// This table with what is missing predicted and marked so: the average body of that build,
    /// moved as the survey's adults differ who have the values given instead of the average body's
    /// (ANSUR II, 2012). So the average body's own values give the average body, and any other
    /// value moves the rest by the regression's slope alone. A table with one of
    /// `FURTHER_OBSERVATIONS` cannot be set beside it: the survey alone predicts the rest. A child
    /// is completed from the average child of its stature.
    pub fn completed(&self, build: Build) -> Self {
        if let Build::Child(age) = build {
            return self.completed_child(age);
        }
        let statistics = Statistics::of(build);
        let sample = Self::average(build);
        let mut result = self.regressed(&statistics, &sample);
        let average = sample.regressed(&statistics, &sample);
        // The average body, known by the very measurements that this table has.
        let mut alike = Self::new();
        for (name, _) in self.iter() {
            match average.get(name) {
                Some(usual) => {
                    let _ = alike.set(name, usual, Origin::Asked);
                }
                None if FURTHER_OBSERVATIONS.contains(&name) => return result,
                // Nothing is predicted from a name of one's own.
                None => {}
            }
        }
        let alike = alike.regressed(&statistics, &sample);
        let scale = self.scale(&statistics);
        for (name, usual) in average.iter().filter(|(name, _)| !self.contains(name)) {
            if let (Some(value), Some(predicted)) = (result.get(name), alike.get(name)) {
                let moved = value + scale * (usual.value - predicted);
                let _ = result.set(name, moved, Origin::Predicted);
            }
        }
        result
    }

    /// The mean of a build's adults in the survey, with what no survey took from the average body.
    pub(crate) fn of_survey(build: Build) -> Self {
        Self::new().regressed(&Statistics::of(build), &Self::average(build))
    }

    /// This table with what is missing predicted from the survey alone: the mean of its adults who
    /// have the values given; what no survey took, in proportion to what it goes with, from the
    /// average body.
    fn regressed(&self, statistics: &Statistics, average: &Self) -> Self {
        let scale = self.scale(statistics);
        let seen = self.observations(statistics, average, scale);
        let predicted = statistics.given(&seen);
        let mut result = self.clone();
        for (name, value) in NAMES.iter().zip(predicted) {
            // A prediction far from any body stays within reach of the mean.
            let mean = statistics.mean[place(name).unwrap_or_default()];
            let value = scale * value.clamp(0.45 * mean, 2.2 * mean);
            result.fill(name, value);
        }
        result.proportions(average, statistics);
        result
    }

    fn fill(&mut self, name: &str, value: f64) {
        if !self.contains(name) && value.is_finite() {
            // Names here are the catalogue's, and the value is finite.
            let _ = self.set(name, value, Origin::Predicted);
        }
    }

    /// Size over that of an average adult, beyond [`SPAN`].
    fn scale(&self, statistics: &Statistics) -> f64 {
        let mut ratios: Vec<f64> = NAMES
            .iter()
            .enumerate()
            .filter_map(|(k, name)| Some(self.get(name)? / statistics.mean[k]))
            .collect();
        ratios.sort_by(f64::total_cmp);
        let typical = match self.get("height") {
            Some(height) => height / statistics.mean[0],
            None if ratios.is_empty() => 1.0,
            None => ratios[ratios.len() / 2],
        };
        let scale = typical / typical.clamp(SPAN[0], SPAN[1]);
        if scale.is_finite() && scale > 0.0 {
            scale
        } else {
            1.0
        }
    }

    /// The known measurements of the survey: index, value and error (m), at adult size.
    fn observations(
        &self,
        statistics: &Statistics,
        average: &Self,
        scale: f64,
    ) -> Vec<(usize, f64, f64)> {
        let mut seen: Vec<(usize, f64, f64)> = Vec::new();
        let mut note = |name: &str, value: Option<f64>, noise: f64| {
            if let (Some(index), Some(value)) = (place(name), value)
                && !seen.iter().any(|known| known.0 == index)
            {
                seen.push((index, value / scale, noise));
            }
        };
        for name in NAMES {
            note(name, self.get(name), 0.0);
        }
        let get = |name: &str| self.get(name);
        let difference = |a: &str, b: &str| Some(get(a)? - get(b)?);
        note("nape_height", difference("height", "head_l"), 0.01);
        let waist = get("waist")
            .zip(average.get("waist"))
            .map(|(value, usual)| {
                let navel = place("navel_girth").map_or(usual, |k| statistics.mean[k]);
                value * navel / usual
            });
        note("navel_girth", waist, 0.02);
        // The navel lies about 0.02 of the stature below the natural waist.
        let drop = 0.02 * statistics.mean[0] * scale;
        let level = get("waist_height").or_else(|| get("outside_leg"));
        note("navel_height", level.map(|level| level - drop), 0.02);
        let over = level
            .zip(get("waist_line"))
            .map(|(waist, back)| waist + back);
        note("nape_height", over, 0.02);
        let side = level
            .zip(get("hps_to_waist_back"))
            .map(|(waist, back)| waist + back);
        note("nape_height", side, 0.03);
        let crotch = level
            .zip(get("waist_to_crotch"))
            .map(|(waist, rise)| waist - rise);
        note("inside_leg", crotch, 0.01);
        seen
    }

    /// Predicts measurements that are in proportion to others.
    fn proportions(&mut self, average: &Self, statistics: &Statistics) {
        let usual_leg = |table: &Self| -> Option<f64> {
            Some(
                table.get("height")?
                    - table.get("head_l")?
                    - table.get("waist_line")?
                    - table.get("hips_line")?
                    - table.get("crotch_hip_diff")?,
            )
        };
        let (Some(height), Some(nape), Some(leg)) = (
            self.get("height"),
            self.get("nape_height"),
            self.get("inside_leg"),
        ) else {
            return;
        };
        let (Some(usual_height), Some(usual_head)) = (average.get("height"), average.get("head_l"))
        else {
            return;
        };
        let usual_trunk = usual_height - usual_head - usual_leg(average).unwrap_or(0.45 * height);
        let trunk = (nape - leg) / usual_trunk;
        self.fill("head_l", height - nape);
        let usual = |name: &str| -> Option<f64> {
            average
                .get(name)
                .or_else(|| place(name).map(|k| statistics.mean[k]))
        };
        for (name, with) in GIRTH_LIKE {
            let ratios: Vec<f64> = with
                .iter()
                .filter_map(|with| Some(self.get(with)? / usual(with)?))
                .collect();
            if let Some(value) = usual(name)
                && !ratios.is_empty()
            {
                self.fill(
                    name,
                    value * ratios.iter().sum::<f64>() / ratios.len() as f64,
                );
            }
        }
        for name in TRUNK_LENGTHS {
            if let Some(value) = average.get(name) {
                self.fill(name, value * trunk);
            }
        }
        for name in ["shoulder_incl", "hip_inclination", "arm_pose_angle"] {
            if let Some(value) = average.get(name) {
                self.fill(name, value);
            }
        }
    }
}

/// Breadths and girths in proportion to others, those first that others stand on.
const GIRTH_LIKE: [(&str, &[&str]); 9] = [
    ("waist", &["navel_girth"]),
    ("underbust", &["bust", "waist"]),
    ("neck_w", &["neck"]),
    ("bust_points", &["bust"]),
    ("back_width", &["bust"]),
    ("waist_back_width", &["waist"]),
    ("hip_back_width", &["hips"]),
    ("bum_points", &["hips"]),
    ("armscye_depth", &["shoulder_w", "upper_arm"]),
];

/// Lengths in proportion to the way from the crotch to the nape.
const TRUNK_LENGTHS: [&str; 6] = [
    "waist_line",
    "hips_line",
    "crotch_hip_diff",
    "vert_bust_line",
    "bust_line",
    "waist_over_bust_line",
];

#[cfg(test)]
mod tests {
    use super::*;

    fn asked(rows: &[(&str, f64)]) -> Measurements {
        let mut table = Measurements::new();
        for &(name, value) in rows {
            table.set(name, value, Origin::Asked).unwrap();
        }
        table
    }

    #[test]
    fn the_survey_alone_gives_its_mean() {
        for (build, survey) in [(Build::Woman, &WOMEN), (Build::Man, &MEN)] {
            let full = Measurements::of_survey(build);
            for (k, name) in NAMES.iter().enumerate() {
                let measured = full.measured(name).unwrap();
                assert_eq!(measured.origin, Origin::Predicted);
                assert!((measured.value - f64::from(survey.mean[k]) * 1e-4).abs() < 1e-12);
            }
        }
    }

    /// The average body of a build with all its measurements.
    fn average(build: Build) -> Measurements {
        Measurements::average(build).completed(build)
    }

    const BUILDS: [Build; 3] = [Build::Woman, Build::Man, Build::Either];

    #[test]
    fn the_average_body_s_own_values_give_the_average_body() {
        for build in BUILDS {
            let average = average(build);
            let all: Vec<(&str, f64)> = average.iter().map(|(name, m)| (name, m.value)).collect();
            let few = ["height", "waist", "inside_leg", "waist_line"];
            let few = few.map(|name| (name, average.get(name).unwrap()));
            let one = all.iter().map(std::slice::from_ref);
            for rows in one.chain([&[][..], &few, &all[..9], &all[7..], &all]) {
                let full = asked(rows).completed(build);
                assert_eq!(full.len(), average.len());
                for (name, usual) in &all {
                    let value = full.get(name).unwrap();
                    assert!(
                        (value - usual).abs() < 1e-12,
                        "{rows:?}: {name} {value} {usual}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_girth_moves_the_others_by_the_slope_of_the_regression() {
        for build in BUILDS {
            let (average, statistics) = (average(build), Statistics::of(build));
            for girth in ["bust", "hips", "neck", "wrist"] {
                let usual = average.get(girth).unwrap();
                let [one, two] = [0.01, 0.02].map(|more| asked(&[(girth, usual + more)]));
                let [one, two] = [one, two].map(|table| table.completed(build));
                let of = place(girth).unwrap();
                for (name, start) in average.iter().filter(|(name, _)| *name != girth) {
                    let [one, two] = [&one, &two].map(|t| t.get(name).unwrap() - start.value);
                    assert!(
                        (two - 2.0 * one).abs() < 1e-12,
                        "{girth} {name}: {one} {two}"
                    );
                    if let Some(k) = place(name) {
                        let slope = statistics.correlation[k][of] * statistics.deviation[k]
                            / statistics.deviation[of]
                            / (1.0 + 1e-4);
                        assert!((one - 0.01 * slope).abs() < 1e-12, "{girth} {name}: {one}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_table_that_the_average_body_is_not_known_by_is_predicted_by_the_survey_alone() {
        let table = asked(&[("height", 1.7), ("waist", 0.7), ("hps_to_waist_back", 0.43)]);
        for build in BUILDS {
            let alone = table.regressed(&Statistics::of(build), &Measurements::average(build));
            assert!(!average(build).contains("hps_to_waist_back"));
            assert_eq!(table.completed(build), alone);
        }
    }

    #[test]
    fn a_girth_beside_the_own_height_leaves_the_lengths_of_the_trunk() {
        let average = average(Build::Woman);
        let height = average.get("height").unwrap();
        let full = asked(&[("height", height), ("waist", 0.7)]).completed(Build::Woman);
        for name in ["waist_line", "hips_line", "arm_length", "inside_leg"] {
            let [now, usual] = [&full, &average].map(|table| table.get(name).unwrap());
            assert!((now - usual).abs() < 0.012, "{name}: {usual} {now}");
        }
    }

    #[test]
    fn asked_values_stay_and_draw_the_others() {
        let tall = asked(&[("height", 1.8)]).completed(Build::Woman);
        let mean = Measurements::new().completed(Build::Woman);
        assert_eq!(tall.get("height"), Some(1.8));
        assert_eq!(tall.measured("height").unwrap().origin, Origin::Asked);
        // One regressor: the slope is r s_y / s_x.
        let leg = place("inside_leg").unwrap();
        let r = Statistics::of(Build::Woman).correlation[leg][0];
        let slope = r * f64::from(WOMEN.deviation[leg]) / f64::from(WOMEN.deviation[0]);
        let rise = tall.get("inside_leg").unwrap() - mean.get("inside_leg").unwrap();
        let expected = slope * (1.8 - mean.get("height").unwrap());
        assert!(
            (rise - expected).abs() < 2e-4 * expected.abs() + 1e-9,
            "{rise} {expected}"
        );
        assert!(tall.get("waist_line").unwrap() > mean.get("waist_line").unwrap());
    }

    #[test]
    fn a_name_of_ones_own_changes_no_prediction() {
        let known = [("height", 1.66), ("waist", 0.7)];
        let usual = asked(&known).completed(Build::Woman);
        let own = asked(&[known[0], known[1], ("pocket", 0.15)]).completed(Build::Woman);
        for (name, measured) in usual.iter() {
            assert_eq!(own.get(name), Some(measured.value), "{name}");
        }
    }

    #[test]
    fn dolls_and_giants_are_scaled_adults() {
        let adult = asked(&[("height", 0.8 * 1.6285), ("bust", 0.8)]).completed(Build::Woman);
        let doll = asked(&[("height", 0.08 * 1.6285), ("bust", 0.08)]).completed(Build::Woman);
        for name in NAMES {
            let (a, d) = (adult.get(name).unwrap(), doll.get(name).unwrap());
            assert!((a - 10.0 * d).abs() < 2e-3, "{name}: {a} {d}");
        }
    }

    #[test]
    fn an_empty_or_absurd_table_stays_finite() {
        for rows in [
            vec![],
            vec![("height", 1e-9)],
            vec![("height", 1e9), ("waist", -1.0)],
            vec![("waist", 0.0)],
        ] {
            let full = asked(&rows).completed(Build::Either);
            assert!(full.iter().all(|(_, m)| m.value.is_finite()));
            assert!(full.contains("waist_line") && full.contains("underbust"));
        }
    }
}
