//! Reads whole bodies from OBJ files, where there are any.

use std::path::{Path, PathBuf};
use toile_interchange::{ObjMesh, read_obj, write_obj};

/// The folder of real test material, where there is one.
fn shared_data() -> Option<PathBuf> {
    let named = std::env::var_os("TOILE_SHARED").map(|folder| PathBuf::from(folder).join("data"));
    let above = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
    named
        .into_iter()
        .chain(above.map(|folder| folder.join("shared/data")))
        .find(|folder| folder.is_dir())
}

#[test]
fn whole_bodies_are_read_and_come_back() {
    let Some(folder) = shared_data().map(|folder| folder.join("body/makehuman")) else {
        println!("skipped: no shared data folder");
        return;
    };
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "obj") {
            continue;
        }
        let mesh = read_obj(&std::fs::read(&path).unwrap())
            .unwrap()
            .into_triangle_mesh();
        mesh.check().unwrap();
        let [low, high] = mesh.bounds().unwrap();
        assert!((0.9..2.2).contains(&(high - low).y), "{}", path.display());
        let text = write_obj(&ObjMesh::from(mesh.clone())).unwrap();
        let back = read_obj(text.as_bytes()).unwrap();
        assert_eq!(back.triangles, mesh.triangles);
        assert_eq!(write_obj(&back).unwrap(), text);
        count += 1;
    }
    assert!(count > 0);
}
