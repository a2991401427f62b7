//! Parser from tokens to a program, by recursive descent.

use std::ops::Range;

use super::Symbol;
use super::error::{ExpressionError, ExpressionProblem};
use super::functions::{self, Function, Named};
use super::program::{Comparison, Program, Step};
use super::token::{Token, tokens};

/// Maximum nesting depth: enough for any formula, and far from the end of the thread's stack.
const DEEPEST: u32 = 200;
/// Integer exponents up to this are computed by multiplication.
const LARGEST_POWER: f64 = 64.0;

pub(super) fn parse(text: &str, symbol: &dyn Fn(&str) -> Option<Symbol>) -> Result<Program, ExpressionError> {
    let mut parser = Parser { tokens: tokens(text)?, at: 0, symbol, program: Program::default(), depth: 0 };
    if parser.tokens.len() == 1 {
        return Err(ExpressionError { problem: ExpressionProblem::Empty, place: 0..text.len() });
    }
    parser.comparison()?;
    match parser.peek() {
        Token::End => Ok(parser.program),
        Token::Sign(sign) if comparison(sign).is_some() => Err(parser.wrong(ExpressionProblem::SecondComparison)),
        _ => Err(parser.expected("an operator or the end of the formula")),
    }
}

/// Returns the comparison of that sign.
fn comparison(sign: &str) -> Option<Comparison> {
    const SIGNS: [(&str, Comparison); 6] = [
        ("<", Comparison::Less),
        ("<=", Comparison::LessOrEqual),
        (">", Comparison::Greater),
        (">=", Comparison::GreaterOrEqual),
        ("==", Comparison::Equal),
        ("!=", Comparison::NotEqual),
    ];
    SIGNS.into_iter().find(|(name, _)| *name == sign).map(|(_, comparison)| comparison)
}

struct Parser<'a> {
    tokens: Vec<(Token, Range<usize>)>,
    at: usize,
    symbol: &'a dyn Fn(&str) -> Option<Symbol>,
    program: Program,
    depth: u32,
}

type Parsed = Result<(), ExpressionError>;

impl Parser<'_> {
    fn peek(&self) -> &Token {
        &self.tokens[self.at].0
    }

    fn place(&self) -> Range<usize> {
        self.tokens[self.at].1.clone()
    }

    /// Advances to the next token; stays at the end.
    fn advance(&mut self) {
        self.at = (self.at + 1).min(self.tokens.len() - 1);
    }

    fn take(&mut self, sign: &str) -> bool {
        let is_next = matches!(self.peek(), Token::Sign(other) if *other == sign);
        if is_next {
            self.advance();
        }
        is_next
    }

    fn wrong(&self, problem: ExpressionProblem) -> ExpressionError {
        ExpressionError { problem, place: self.place() }
    }

    fn expected(&self, expected: &'static str) -> ExpressionError {
        let found = match self.peek() {
            Token::Number(number) => format!("the number {number}"),
            Token::Name(name) => format!("`{name}`"),
            Token::Sign(sign) => format!("`{sign}`"),
            Token::End => "the end of the formula".to_owned(),
        };
        self.wrong(ExpressionProblem::Expected { expected, found })
    }

    fn deeper(&mut self, inside: impl FnOnce(&mut Self) -> Parsed) -> Parsed {
        if self.depth == DEEPEST {
            return Err(self.wrong(ExpressionProblem::TooDeep));
        }
        self.depth += 1;
        inside(self)?;
        self.depth -= 1;
        Ok(())
    }

    fn comparison(&mut self) -> Parsed {
        self.sum()?;
        if let Token::Sign(sign) = *self.peek()
            && let Some(comparison) = comparison(sign)
        {
            self.advance();
            self.sum()?;
            self.program.push(Step::Compare(comparison));
        }
        Ok(())
    }

    fn sum(&mut self) -> Parsed {
        self.left_to_right(Self::product, [("+", Step::Add), ("-", Step::Subtract)])
    }

    fn product(&mut self) -> Parsed {
        self.left_to_right(Self::signed, [("*", Step::Multiply), ("/", Step::Divide)])
    }

    /// Parses operands joined by the signs of `steps`, which are evaluated from left to right.
    fn left_to_right(&mut self, operand: fn(&mut Self) -> Parsed, steps: [(&str, Step); 2]) -> Parsed {
        operand(self)?;
        while let Some((_, step)) = steps.into_iter().find(|(sign, _)| self.take(sign)) {
            operand(self)?;
            self.program.push(step);
        }
        Ok(())
    }

    fn signed(&mut self) -> Parsed {
        if self.take("-") {
            self.deeper(Self::signed)?;
            self.program.push(Step::Negate);
            Ok(())
        } else if self.take("+") {
            self.deeper(Self::signed)
        } else {
            self.power()
        }
    }

    fn power(&mut self) -> Parsed {
        self.primary()?;
        if !self.take("^") {
            return Ok(());
        }
        self.deeper(Self::signed)?;
        match self.program.steps().last() {
            Some(&Step::Number(power)) if power.fract() == 0.0 && (2.0..=LARGEST_POWER).contains(&power.abs()) => {
                self.program.pop();
                self.program.push(Step::Power(power as i32));
            }
            _ => self.program.push(Step::Raise),
        }
        Ok(())
    }

    fn primary(&mut self) -> Parsed {
        match self.peek().clone() {
            Token::Number(number) => {
                self.advance();
                self.program.push(Step::Number(number));
                Ok(())
            }
            Token::Name(name) => {
                let place = self.place();
                self.advance();
                if !self.take("(") {
                    return self.name(&name, place);
                }
                let function = self.function(&name, place.clone())?;
                self.call(function, place)
            }
            Token::Sign("(") => {
                self.advance();
                self.deeper(Self::comparison)?;
                if self.take(")") { Ok(()) } else { Err(self.expected("an operator or `)`")) }
            }
            _ => Err(self.expected("a number, a name or `(`")),
        }
    }

    fn name(&mut self, name: &str, place: Range<usize>) -> Parsed {
        let number = functions::number(name).map(Symbol::Number);
        let problem = match (number.or_else(|| (self.symbol)(name)), functions::named(name)) {
            (Some(symbol), _) => {
                self.program.push(match symbol {
                    Symbol::Input(number) => Step::Input(number),
                    Symbol::Number(number) => Step::Number(number),
                });
                return Ok(());
            }
            (None, Some(function)) => {
                ExpressionProblem::NoArguments { name: name.to_owned(), arguments: function.1.arguments().2 }
            }
            (None, None) => ExpressionProblem::UnknownName(name.to_owned()),
        };
        Err(ExpressionError { problem, place })
    }

    /// Returns the function of that name, which is followed by `(`.
    fn function(&self, name: &str, place: Range<usize>) -> Result<Named, ExpressionError> {
        functions::named(name).ok_or_else(|| {
            let problem = match name {
                "log" => ExpressionProblem::Log,
                _ if functions::number(name).is_some() || (self.symbol)(name).is_some() => {
                    ExpressionProblem::NotAFunction(name.to_owned())
                }
                _ => ExpressionProblem::UnknownFunction(name.to_owned()),
            };
            ExpressionError { problem, place }
        })
    }

    /// Parses the arguments of a function, after `(`.
    fn call(&mut self, (name, function): Named, place: Range<usize>) -> Parsed {
        let mut count = 0;
        if !self.take(")") {
            loop {
                self.deeper(Self::comparison)?;
                count += 1;
                if let (Function::Several(of_two), 2..) = (function, count) {
                    self.program.push(Step::Two(name, of_two));
                }
                if self.take(")") {
                    break;
                }
                if !self.take(",") {
                    return Err(self.expected("an operator, `,` or `)`"));
                }
            }
        }
        let (counts, expected, _) = function.arguments();
        if !counts.contains(&count) {
            let name = name.to_owned();
            return Err(ExpressionError {
                problem: ExpressionProblem::Arity { name, expected, found: count },
                place: place.start..self.tokens[self.at - 1].1.end,
            });
        }
        match function {
            Function::One(of_one) => self.program.push(Step::One(name, of_one)),
            Function::Two(of_two) => self.program.push(Step::Two(name, of_two)),
            Function::Select => self.program.push(Step::Select),
            Function::Several(_) => (),
        }
        Ok(())
    }
}
