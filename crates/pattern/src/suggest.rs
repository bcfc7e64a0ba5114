//! Suggests the known name nearest to an unknown one.

/// Number of characters at the beginning of a name that are compared.
const COMPARED: usize = 40;

/// The known name most similar to `name`, if it is similar enough to be suggested.
pub fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let wanted: Vec<char> = name.chars().take(COMPARED).collect();
    known
        .take(1000)
        .map(|candidate| (distance(&wanted, candidate), candidate))
        .min()
        .filter(|&(steps, _)| steps <= ((wanted.len() + 1) / 3).max(1))
        .map(|(_, candidate)| candidate)
}

/// Edit distance (Levenshtein 1966); upper and lower case count as the same.
fn distance(wanted: &[char], candidate: &str) -> usize {
    let mut row: Vec<usize> = (0..=wanted.len()).collect();
    for (k, c) in candidate.chars().take(COMPARED).enumerate() {
        let mut diagonal = row[0];
        row[0] = k + 1;
        for (j, w) in wanted.iter().enumerate() {
            let change = diagonal + usize::from(!w.eq_ignore_ascii_case(&c));
            diagonal = row[j + 1];
            row[j + 1] = change.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[wanted.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_what_was_meant_and_nothing_else() {
        let known = ["bust", "waist", "hips"];
        assert_eq!(nearest("Bust", known.into_iter()), Some("bust"));
        assert_eq!(nearest("wiast", known.into_iter()), Some("waist"));
        assert_eq!(nearest("waits", known.into_iter()), Some("waist"));
        assert_eq!(nearest("waist_", known.into_iter()), Some("waist"));
        assert_eq!(nearest("elephant", known.into_iter()), None);
        assert_eq!(nearest("", known.into_iter()), None);
    }
}
