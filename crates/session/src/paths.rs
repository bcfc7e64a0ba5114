//! Relative paths from a folder to a file, so that files that lie together can be moved together.

use std::path::{Component, Path, PathBuf};

/// Absolute path of a file or a folder, without symbolic links; it need not exist yet.
pub(crate) fn resolved(path: &Path) -> PathBuf {
    // The folder of a bare file name is the working directory.
    let path = match path.as_os_str().is_empty() {
        true => Path::new("."),
        false => path,
    };
    let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let there = whole
        .ancestors()
        .find_map(|a| Some((a, a.canonicalize().ok()?)));
    match there {
        Some((ancestor, real)) => match whole.strip_prefix(ancestor) {
            Ok(rest) if rest.as_os_str().is_empty() => real,
            Ok(rest) => real.join(rest),
            Err(_) => whole,
        },
        None => whole,
    }
}

/// Relative path from a folder to a file; `None` if they have no common root.
pub(crate) fn relative(file: &Path, folder: &Path) -> Option<PathBuf> {
    let parts = |path: &Path| {
        path.components()
            .map(|c| c.as_os_str().to_owned())
            .collect()
    };
    let (to, from): (Vec<_>, Vec<_>) = (parts(file), parts(folder));
    let common = to.iter().zip(&from).take_while(|(a, b)| a == b).count();
    let up = from
        .iter()
        .skip(common)
        .map(|_| Component::ParentDir.as_os_str());
    let way: PathBuf = up
        .chain(to.iter().skip(common).map(|part| &**part))
        .collect();
    (common > 0).then_some(way)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_folder_of_a_bare_name_is_the_one_that_is_worked_in() {
        let folder = Path::new("p.json").parent().unwrap();
        let here = resolved(folder);
        assert!(here.is_absolute());
        let way = relative(&resolved(Path::new("tables/w.json")), &here);
        assert_eq!(way.as_deref(), Some(Path::new("tables/w.json")));
    }

    #[test]
    fn the_way_from_a_folder_to_a_file() {
        let way = |file: &str, folder: &str| {
            relative(Path::new(file), Path::new(folder))
                .unwrap()
                .display()
                .to_string()
        };
        assert_eq!(way("/a/b/p.json", "/a/out"), "../b/p.json");
        assert_eq!(way("/a/p.json", "/a"), "p.json");
        assert_eq!(way("/p.json", "/a/b"), "../../p.json");
    }
}
