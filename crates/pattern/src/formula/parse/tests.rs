//! Formulas that are read, and refusals of those that are none.

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
    ] {
        let formula = read(text).unwrap();
        let printed = formula.text(&Names::default());
        assert_eq!(read(&printed).unwrap(), formula, "{text}");
        assert_eq!(printed, text);
    }
}
