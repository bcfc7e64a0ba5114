fn main() {
    for path in std::env::args().skip(1) {
        let text = std::fs::read_to_string(&path).unwrap();
        let Ok((pattern, _)) = toile_interchange::read_pattern(&text) else {
            continue;
        };
        let written = match toile_interchange::write_pattern(&pattern) {
            Ok(w) => w,
            Err(e) => {
                println!("{path}: {e}");
                continue;
            }
        };
        if path.contains("trousers") {
            println!("{written}");
        }
        match toile_interchange::read_pattern(&written) {
            Ok((again, notes)) => {
                if again != pattern || !notes.is_empty() {
                    println!("{path}: differs {notes:?}");
                    if again.sheets != pattern.sheets {
                        println!("sheets")
                    }
                    if again.panels != pattern.panels {
                        println!("panels {:?}\n{:?}", again.panels[0], pattern.panels[0])
                    }
                    if again.seams != pattern.seams {
                        println!("seams")
                    }
                    if again.variables != pattern.variables {
                        println!("var")
                    }
                }
            }
            Err(e) => println!("{path}: {e}"),
        }
    }
}
