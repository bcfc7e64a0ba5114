fn main() {
    for path in std::env::args().skip(1) {
        let text = std::fs::read_to_string(&path).unwrap();
        let (pattern, _) = toile_interchange::read_pattern(&text).unwrap();
        let body = pattern
            .base_measurements()
            .cloned()
            .unwrap_or_else(toile_measure::Measurements::adult);
        for d in pattern.check(&body) {
            println!("{path}: {d} [{}]", pattern.describe(&d.place));
        }
    }
}
