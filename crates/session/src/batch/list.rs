//! The jobs of a batch: each pattern in each size, fabric and body, where a command takes them.

use super::job::{Asked, FileDigests, Job};
use super::spec::{AskedSizes, Named, Spec};
use super::work::{FILE, Work};
use crate::fabrics::is_known_fabric;
use crate::fitting::files_to_try_on;
use crate::{OpenOptions, PanelOrigin, Project, SessionError};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use toile_interchange::Format;
use toile_pattern::fields::Choice;

/// Most jobs of a batch.
const MAX_JOBS: usize = 100_000;

/// Lists the jobs of a batch, each pattern's together. A pattern that cannot be read has its jobs, too: they fail
/// and say why, and the others are done.
///
/// # Errors
/// A size or a fabric that a pattern does not have, or more jobs than are taken.
pub fn list_jobs(spec: &Spec) -> Result<Vec<Job>, SessionError> {
    let mut jobs = Vec::new();
    let mut digests = FileDigests::default();
    for pattern in &spec.patterns {
        let path = Path::new(&pattern.argument);
        let options = OpenOptions::default();
        let opened = Project::open_from(path, PanelOrigin::Automatic, &options).ok();
        let project = opened.as_ref().map(|opened| &opened.project);
        let companions = opened.iter().flat_map(|opened| &opened.found.companions);
        let files = project.map(files_to_try_on).unwrap_or_default();
        let own = OwnJobs {
            spec,
            pattern,
            sizes: sizes(spec, pattern, project)?,
            files: companions.cloned().chain(files).collect(),
        };
        if let Some(project) = project {
            check_fabrics(spec, pattern, project)?;
        }
        for &work in &spec.works {
            own.add(work, &mut digests, &mut jobs)?;
        }
    }
    let mut ids = BTreeSet::new();
    for job in &mut jobs {
        if !ids.insert(job.id.clone()) {
            job.lengthen_id();
            ids.insert(job.id.clone());
        }
    }
    Ok(jobs)
}

/// What the jobs of one pattern have in common.
struct OwnJobs<'a> {
    spec: &'a Spec,
    pattern: &'a Named,
    sizes: Vec<Option<String>>,
    /// Absolute paths of the files that the pattern names.
    files: Vec<PathBuf>,
}

impl OwnJobs<'_> {
    /// Adds the jobs of one command.
    fn add(
        &self,
        work: Work,
        digests: &mut FileDigests,
        jobs: &mut Vec<Job>,
    ) -> Result<(), SessionError> {
        let spec = self.spec;
        let options = spec.options.get(&work).cloned().unwrap_or_default();
        let sizes = match work {
            Work::Convert => self.sizes_to_write(&options),
            Work::Make | Work::Drape | Work::Nest | Work::Print | Work::Check => self.sizes.clone(),
        };
        let own = [None];
        let (fabrics, bodies) = match work.takes_body() {
            true => (&spec.fabrics[..], &spec.bodies[..]),
            false => (&own[..], &own[..]),
        };
        for size in &sizes {
            for fabric in fabrics {
                for body in bodies {
                    let argument = |named: &Option<Named>| Some(named.as_ref()?.argument.clone());
                    let asked = Asked {
                        work,
                        named: self.pattern.word.clone(),
                        pattern: self.pattern.argument.clone(),
                        size: size.clone(),
                        fabric: argument(fabric),
                        body: argument(body),
                        options: options.clone(),
                        files: self.files.clone(),
                        limits: spec.limits,
                    };
                    jobs.push(Job::new(asked, digests));
                    if jobs.len() > MAX_JOBS {
                        let what = format!("more than {MAX_JOBS} jobs");
                        let hint = "divide the batch into several, each with its own --out";
                        return Err(spec.refuse("the file".to_owned(), what, hint));
                    }
                }
            }
        }
        Ok(())
    }

    /// Sizes of a conversion: one file for all where the format holds them.
    fn sizes_to_write(
        &self,
        options: &std::collections::BTreeMap<String, Option<String>>,
    ) -> Vec<Option<String>> {
        let value = |name: &str| options.get(name)?.as_deref();
        let format = match (value("to"), value(FILE)) {
            (Some(word), _) => Format::all().iter().find(|of| of.word() == word).copied(),
            (None, Some(file)) => Format::of_name(file),
            (None, None) => None,
        };
        match format {
            Some(format) if format.holds_sizes() => {
                let names: Option<Vec<&str>> = self.sizes.iter().map(Option::as_deref).collect();
                vec![names.map(|names| names.join(","))]
            }
            Some(format) if format.holds_shapes() => self.sizes.clone(),
            _ => vec![None],
        }
    }
}

/// The sizes of one pattern that are asked for.
fn sizes(
    spec: &Spec,
    pattern: &Named,
    project: Option<&Project>,
) -> Result<Vec<Option<String>>, SessionError> {
    let own = project.map(|project| project.pattern.sizes.iter().map(|size| size.name.clone()));
    match (&spec.sizes, own) {
        (AskedSizes::Kept, _) | (AskedSizes::All, None) => Ok(vec![None]),
        (AskedSizes::All, Some(own)) => {
            let own: Vec<Option<String>> = own.map(Some).collect();
            match own.is_empty() {
                true => Ok(vec![None]),
                false => Ok(own),
            }
        }
        (AskedSizes::Named(names), None) => Ok(names.iter().cloned().map(Some).collect()),
        (AskedSizes::Named(names), Some(own)) => {
            let own: Vec<String> = own.collect();
            let missing = names.iter().position(|name| !own.contains(name));
            match missing {
                None => Ok(names.iter().cloned().map(Some).collect()),
                Some(k) => {
                    let has = match own.is_empty() {
                        true => "it has no table of sizes".to_owned(),
                        false => format!("it has {}", own.join(", ")),
                    };
                    let what = format!("{} has no size {:?}: {has}", pattern.word, names[k]);
                    let hint = "name sizes that all patterns have, write \"all\", or make a batch of its own";
                    Err(spec.refuse(format!("sizes[{k}]"), what, hint))
                }
            }
        }
    }
}

fn check_fabrics(spec: &Spec, pattern: &Named, project: &Project) -> Result<(), SessionError> {
    for (k, fabric) in spec.fabrics.iter().enumerate() {
        let Some(fabric) = fabric else { continue };
        let is_file = Path::new(&fabric.argument).is_absolute();
        if !is_file && !is_known_fabric(&project.pattern, &fabric.argument) {
            let what = format!(
                "there is no file {:?}, and {} and the library have no fabric of that name",
                fabric.word, pattern.word
            );
            let hint = "give silk, chiffon, poplin, cotton, jersey, wool, denim, leather, felt, flag-nylon, a fabric of the pattern, or a fabric file";
            return Err(spec.refuse(format!("fabrics[{k}]"), what, hint));
        }
    }
    Ok(())
}
