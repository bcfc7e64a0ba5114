//! Formulas of Valentina and Seamly2D as trees.

/// Deepest nesting that is read: beyond it a formula is damaged.
const MAX_DEPTH: usize = 40;

/// A formula of Valentina or Seamly2D.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Expression {
    /// A number without a unit.
    Literal(f64),
    /// A measurement, an increment, or a value of the drawing.
    Name(String),
    /// A value with the opposite sign.
    Negative(Box<Expression>),
    /// Two values joined by an operator.
    Pair(Operator, Box<[Expression; 2]>),
    /// A condition, the value if it holds, and the value if not.
    Choice(Box<[Expression; 3]>),
    /// A function with its arguments.
    Call(String, Vec<Expression>),
}

/// An operator between two values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Operator {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Less,
    LessOrEqual,
    More,
    MoreOrEqual,
    Equal,
    Unequal,
    And,
    Or,
}

/// Operators from the weakest to the strongest, each with its text; longer texts stand before their starts.
const LEVELS: &[&[(&str, Operator)]] = &[
    &[("||", Operator::Or)],
    &[("&&", Operator::And)],
    &[
        ("<=", Operator::LessOrEqual),
        (">=", Operator::MoreOrEqual),
        ("!=", Operator::Unequal),
        ("==", Operator::Equal),
        ("<", Operator::Less),
        (">", Operator::More),
    ],
    &[("+", Operator::Add), ("-", Operator::Subtract)],
    &[("*", Operator::Multiply), ("/", Operator::Divide)],
];

/// Characters that end a name.
const ENDS_OF_NAMES: &str = "()+-*/^<>=!?:;,&|";

impl Expression {
    /// Reads a formula.
    ///
    /// # Errors
    /// The fault in words.
    pub fn read(text: &str) -> Result<Self, String> {
        let mut reader = Reader {
            rest: text,
            depth: 0,
            calls: 0,
        };
        let read = reader.choice()?;
        match reader.peek() {
            None => Ok(read),
            Some(c) => Err(format!("{c:?} is not expected in {text:?}")),
        }
    }

    /// Calls a function for each name in the formula.
    pub fn each_name<'e>(&'e self, call: &mut impl FnMut(&'e str)) {
        match self {
            Self::Literal(_) => {}
            Self::Name(name) => call(name),
            Self::Negative(of) => of.each_name(call),
            Self::Pair(_, pair) => pair.iter().for_each(|one| one.each_name(call)),
            Self::Choice(three) => three.iter().for_each(|one| one.each_name(call)),
            Self::Call(_, arguments) => arguments.iter().for_each(|one| one.each_name(call)),
        }
    }
}

struct Reader<'a> {
    rest: &'a str,
    depth: usize,
    /// Functions whose arguments are being read: between these a comma separates.
    calls: usize,
}

impl Reader<'_> {
    fn peek(&mut self) -> Option<char> {
        self.rest = self.rest.trim_start();
        self.rest.chars().next()
    }

    fn take(&mut self, text: &str) -> bool {
        self.rest = self.rest.trim_start();
        match self.rest.strip_prefix(text) {
            Some(rest) => {
                self.rest = rest;
                true
            }
            None => false,
        }
    }

    fn want(&mut self, text: &str) -> Result<(), String> {
        match self.take(text) {
            true => Ok(()),
            false => Err(format!("{text:?} is missing before {:?}", self.rest)),
        }
    }

    fn choice(&mut self) -> Result<Expression, String> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err("it is nested too deep".to_owned());
        }
        let condition = self.level(0)?;
        let read = match self.take("?") {
            false => condition,
            true => {
                let then = self.choice()?;
                self.want(":")?;
                Expression::Choice(Box::new([condition, then, self.choice()?]))
            }
        };
        self.depth -= 1;
        Ok(read)
    }

    fn level(&mut self, level: usize) -> Result<Expression, String> {
        let Some(operators) = LEVELS.get(level) else {
            return self.unary();
        };
        let mut left = self.level(level + 1)?;
        loop {
            let found = operators.iter().find(|(text, _)| self.take(text));
            let Some((_, operator)) = found else {
                return Ok(left);
            };
            let right = self.level(level + 1)?;
            left = Expression::Pair(*operator, Box::new([left, right]));
        }
    }

    fn unary(&mut self) -> Result<Expression, String> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err("it is nested too deep".to_owned());
        }
        let read = if self.take("-") {
            Expression::Negative(Box::new(self.unary()?))
        } else if self.take("+") {
            self.unary()?
        } else {
            let base = self.primary()?;
            match self.take("^") {
                false => base,
                true => Expression::Pair(Operator::Power, Box::new([base, self.unary()?])),
            }
        };
        self.depth -= 1;
        Ok(read)
    }

    fn primary(&mut self) -> Result<Expression, String> {
        let first = self.peek().ok_or("it ends too early")?;
        if self.take("(") {
            let inner = self.choice()?;
            self.want(")")?;
            return Ok(inner);
        }
        if first.is_ascii_digit() || first == '.' {
            return self.literal();
        }
        let is_end = |c: char| c.is_whitespace() || ENDS_OF_NAMES.contains(c);
        let end = self.rest.find(is_end).unwrap_or(self.rest.len());
        if end == 0 {
            return Err(format!("{first:?} is not expected"));
        }
        let (name, rest) = self.rest.split_at(end);
        self.rest = rest;
        if !self.take("(") {
            return Ok(Expression::Name(name.to_owned()));
        }
        self.calls += 1;
        let mut arguments = vec![self.choice()?];
        while self.take(";") || self.take(",") {
            arguments.push(self.choice()?);
        }
        self.calls -= 1;
        self.want(")")?;
        Ok(Expression::Call(name.to_owned(), arguments))
    }

    fn literal(&mut self) -> Result<Expression, String> {
        let bytes = self.rest.as_bytes();
        let digits = |from: usize| {
            let more = bytes.iter().skip(from);
            from + more.take_while(|byte| byte.is_ascii_digit()).count()
        };
        let mut end = digits(0);
        let is_decimal_comma = self.calls == 0
            && bytes.get(end) == Some(&b',')
            && bytes.get(end + 1).is_some_and(u8::is_ascii_digit);
        if bytes.get(end) == Some(&b'.') || is_decimal_comma {
            end = digits(end + 1);
        }
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
            let after = digits(end + 1 + sign);
            if after > end + 1 + sign {
                end = after;
            }
        }
        let (text, rest) = self.rest.split_at(end);
        self.rest = rest;
        let number = text.replace(',', ".").parse();
        let number = number.map_err(|_| format!("{text:?} is no number"))?;
        Ok(Expression::Literal(number))
    }
}
