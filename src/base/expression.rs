//! Boolean expressions as text, over whatever the caller calls an atom: `(0 & !1) | 2`.
//!
//! `!` not; `&` and, `-` and not (as strong as one another, from left to right); `^` one but not both; `|` or, in this order of strength; brackets;
//! `true`, `false`. A word that begins where a value is expected is an atom; so a `-` there is the atom's own.
//!
//! Parsed by operator precedence with a stack into steps in the order of evaluation: nothing recurses, whatever the depth. Cost: linear.

use super::{Error, Result, Status};

/// One step, in the order of evaluation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Step<A> {
    Constant(bool),
    Atom(A),
    Not,
    And,
    Minus,
    Xor,
    Or,
}

/// A boolean expression over atoms.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Expression<A> {
    steps: Vec<Step<A>>,
}

/// What the parser of atoms says about the text from where a value is expected: an atom and its length in bytes (one or more); `None` if no
/// atom begins there; or what is wrong, and how many bytes on.
pub type AtomOrNot<A> = std::result::Result<Option<(A, usize)>, (usize, &'static str)>;

impl<A: Copy> Expression<A> {
    /// `what` names an atom in messages: "a function". Errors: `BadArgument` with the place of the first character that does not fit.
    pub fn parse(text: &str, what: &str, mut atom: impl FnMut(&str) -> AtomOrNot<A>) -> Result<Self> {
        let mut steps = Vec::new();
        // What waits for its right side: operators and opening brackets.
        let mut waiting: Vec<u8> = Vec::new();
        let bytes = text.as_bytes();
        let wrong = |at: usize, what: &str| {
            Error::new(Status::BadArgument, format!("expression, character {}: {what}", at + 1))
        };
        let strength = |operator: u8| match operator {
            b'!' => 4,
            b'&' | b'-' => 3,
            b'^' => 2,
            b'|' => 1,
            _ => 0,
        };
        let step = |operator: u8| match operator {
            b'!' => Step::Not,
            b'&' => Step::And,
            b'-' => Step::Minus,
            b'^' => Step::Xor,
            _ => Step::Or,
        };
        let (mut at, mut complete) = (0, false);
        while at < bytes.len() {
            let c = bytes[at];
            match c {
                b' ' | b'\t' | b'\n' | b'\r' => at += 1,
                b'!' | b'(' if !complete => {
                    waiting.push(c);
                    at += 1;
                }
                b'&' | b'-' | b'^' | b'|' if complete => {
                    while let Some(&top) = waiting.last().filter(|&&top| strength(top) >= strength(c)) {
                        steps.push(step(top));
                        waiting.pop();
                    }
                    waiting.push(c);
                    complete = false;
                    at += 1;
                }
                b')' if complete => {
                    loop {
                        match waiting.pop() {
                            Some(b'(') => break,
                            Some(top) => steps.push(step(top)),
                            None => return Err(wrong(at, "a bracket that was not opened")),
                        }
                    }
                    at += 1;
                }
                _ if complete => return Err(wrong(at, "an operator or the end is expected")),
                // Whatever is not ASCII begins nothing; so `at` is always between characters.
                _ => {
                    let rest = if c.is_ascii() { &text[at..] } else { "" };
                    let word = [("true", true), ("false", false)].into_iter().find(|(w, _)| rest.starts_with(w));
                    if let Some((word, value)) = word {
                        steps.push(Step::Constant(value));
                        at += word.len();
                    } else {
                        match atom(rest) {
                            Ok(Some((a, length))) => {
                                steps.push(Step::Atom(a));
                                at += length;
                            }
                            Ok(None) => return Err(wrong(at, &format!("{what}, `!` or `(` is expected"))),
                            Err((after, message)) => return Err(wrong(at + after, message)),
                        }
                    }
                    complete = true;
                }
            }
        }
        if !complete {
            return Err(wrong(at, "the expression ends too early"));
        }
        while let Some(top) = waiting.pop() {
            if top == b'(' {
                return Err(wrong(at, "a bracket is not closed"));
            }
            steps.push(step(top));
        }
        Ok(Self { steps })
    }

    /// The value where atoms have these values. `stack`: working memory.
    pub fn evaluate(&self, atom: impl Fn(A) -> bool, stack: &mut Vec<bool>) -> bool {
        stack.clear();
        for step in &self.steps {
            let mut pop = || stack.pop().expect("operands come before operators");
            let value = match *step {
                Step::Constant(value) => value,
                Step::Atom(a) => atom(a),
                Step::Not => !pop(),
                Step::And => pop() & pop(),
                // The right side is on top.
                Step::Minus => !pop() & pop(),
                Step::Xor => pop() ^ pop(),
                Step::Or => pop() | pop(),
            };
            stack.push(value);
        }
        stack.pop().expect("one value")
    }
}
