//! Formulas that are read, and refusals of texts that are not formulas.

use super::*;

fn read(text: &str) -> Result<Formula, FormulaError> {
    parse(text, &Names::default())
}

#[test]
fn refusals_name_column_and_remedy() {
    for (text, column, says) in [
        ("", 1, "ends too early"),
        ("bust +", 7, "ends too early"),
        ("bust 4", 6, "not expected"),
        ("2 elephants", 3, "not a unit"),
        ("(bust", 6, "ends too early"),
        ("bust)", 5, "not expected"),
        ("sqroot(2)", 1, "not a function"),
        ("sqrt(1,2)", 1, "given 2 values"),
        ("round(1)", 1, "given 1 values"),
        ("x(front)", 8, "dot is missing"),
        ("if(1, 2)", 8, "comma is missing"),
        ("1 < ", 5, "ends too early"),
        ("@12", 1, "not a value"),
        ("length('front)", 8, "does not end"),
        ("1e999", 6, "too large"),
        (".", 1, "not a number"),
        ("bust # 2", 6, "not expected"),
        ("größe", 3, "not expected"),
        ("length(a.b..c.d)", 13, "another panel"),
        ("length(a.b..?12.d)", 13, "another panel"),
        ("length(a.b.apex..a.d)", 16, "number of the corner"),
        ("length(a.b.knee.0..a.d)", 12, "is no corner"),
        ("length(a.b.apex.0)", 18, ".. is missing"),
        ("length(a..b)", 10, "not a name"),
        ("? + 1", 1, "not the id"),
        ("?99999999999", 1, "not the id"),
        ("length(curve a)", 15, "dot is missing"),
        ("measurement ?12", 13, "not a name"),
    ] {
        let error = read(text).unwrap_err();
        assert_eq!(error.column, column, "{text}: {error}");
        assert!(error.to_string().contains(says), "{text}: {error}");
        assert!(!error.hint.is_empty());
    }
}

#[test]
fn nesting_and_length_are_bounded() {
    let deep = "(".repeat(900) + "1" + &")".repeat(900);
    assert!(read(&deep).unwrap_err().message.contains("deeper"));
    let deep = "if(1,2,".repeat(200) + "3" + &")".repeat(200);
    assert!(read(&deep).unwrap_err().message.contains("deeper"));
    let deep = "not ".repeat(300) + "1";
    assert!(read(&deep).unwrap_err().message.contains("deeper"));
    assert!(read(&"-".repeat(1900)).is_err());
    assert!(read(&"1+".repeat(1001)).is_err());
    assert!(read(&("1+".repeat(900) + "1")).is_ok());
}

#[test]
fn what_is_printed_is_what_was_read() {
    for text in [
        "bust / 4 + 2.5cm",
        "if( bust > 1m , 'left hip' , 0)",
        "length( front.armhole ) + length('a b'.'c d'..'a b'.e)",
        "angle(front.a, front.b) + x(front.c)",
        "not (1 5/8in <= 2cm and 3 != 4) or ?47 = 1",
        "length(?47) + length( seam ?9 ) + finished(curve ?12 )",
        "length(?3.?4..?3.dart.mouth.0) + x(?47) + angle(?4) + angle(?4, sheet a.'b c') + measurement and 1",
    ] {
        let formula = read(text).unwrap();
        let printed = formula.text(&Names::default());
        assert_eq!(read(&printed).unwrap(), formula, "{text}");
        assert_eq!(printed, text);
    }
}
