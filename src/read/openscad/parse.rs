//! Tokens to a document.
//!
//! ```text
//! file      = { statement | ";" }
//! statement = { "*" | "!" | "#" | "%" } name "(" [ argument { "," argument } [ "," ] ] ")" body
//! body      = ";" | "{" file "}" | statement
//! argument  = [ name "=" ] value
//! value     = { "-" | "+" } ( number | "inf" | "nan" )
//!           | string | "true" | "false" | "undef" | "[" [ value { "," value } [ "," ] ] "]"
//! ```

use super::super::error::Located;
use super::lex::{Lexer, Token};
use super::value::{Argument, Document, Modifiers, Statement, Value, advance};
use crate::solid::Place;

/// Parses a text shorter than 4 GiB.
pub(super) fn document(text: &[u8]) -> Result<Document<'_>, Located> {
    let document = Document {
        text,
        statements: Vec::new(),
        arguments: Vec::new(),
        values: Vec::new(),
        offsets: Vec::new(),
    };
    let place = Place { line: 1, column: 1 };
    let mut parser = Parser { lexer: Lexer::new(text)?, document, place, counted: 0 };
    parser.file()?;
    Ok(parser.document)
}

struct Parser<'a> {
    lexer: Lexer<'a>,
    document: Document<'a>,
    /// The place of the offset `counted`, which follows the statements so that counting
    /// lines costs one pass over the text.
    place: Place,
    counted: u32,
}

/// A statement whose body is not complete.
#[derive(Clone, Copy)]
enum Open {
    /// With braces.
    Block(u32),
    /// With one statement as its body.
    Single(u32),
}

impl<'a> Parser<'a> {
    fn file(&mut self) -> Result<(), Located> {
        let mut open: Vec<Open> = Vec::new();
        loop {
            match (self.lexer.token, open.last()) {
                (Token::Symbol(b';'), Some(Open::Block(_)) | None) => {
                    self.lexer.advance()?;
                }
                (Token::Symbol(b'}'), Some(&Open::Block(statement))) => {
                    self.lexer.advance()?;
                    open.pop();
                    self.complete(&mut open, statement);
                }
                (Token::End, None) => return Ok(()),
                (_, Some(Open::Single(_))) => {
                    self.statement("`;`, `{` or a statement", &mut open)?;
                }
                (_, Some(Open::Block(_))) => {
                    self.statement("a statement or `}`", &mut open)?;
                }
                (_, None) => self.statement("a statement", &mut open)?,
            }
        }
    }

    /// Ends a statement, and those whose only body it is.
    fn complete(&mut self, open: &mut Vec<Open>, mut statement: u32) {
        let end = count(&self.document.statements);
        loop {
            self.document.statements[statement as usize].end = end;
            let Some(&Open::Single(outer)) = open.last() else { return };
            open.pop();
            statement = outer;
        }
    }

    /// A statement up to its body.
    fn statement(&mut self, expected: &str, open: &mut Vec<Open>) -> Result<(), Located> {
        let mut modifiers = Modifiers::default();
        let mut expected = expected;
        loop {
            match self.lexer.token {
                Token::Symbol(b'*') => modifiers.disabled = true,
                Token::Symbol(b'!') => modifiers.root = true,
                Token::Symbol(b'%') => modifiers.background = true,
                Token::Symbol(b'#') => modifiers.highlighted = true,
                Token::Name(name) => {
                    let place = self.place();
                    self.lexer.advance()?;
                    let arguments = self.arguments()?;
                    let this = count(&self.document.statements);
                    let end = this + 1;
                    let statement = Statement { name, place, modifiers, arguments, end };
                    self.document.statements.push(statement);
                    return self.body(this, open);
                }
                Token::Number(_) | Token::Text { .. } | Token::Symbol(_) | Token::End => {
                    return Err(self.lexer.unexpected(expected));
                }
            }
            expected = "a statement";
            self.lexer.advance()?;
        }
    }

    fn body(&mut self, statement: u32, open: &mut Vec<Open>) -> Result<(), Located> {
        match self.lexer.token {
            Token::Symbol(b';') => {
                self.lexer.advance()?;
                self.complete(open, statement);
            }
            Token::Symbol(b'{') => {
                self.lexer.advance()?;
                open.push(Open::Block(statement));
            }
            Token::Name(_)
            | Token::Number(_)
            | Token::Text { .. }
            | Token::Symbol(_)
            | Token::End => open.push(Open::Single(statement)),
        }
        Ok(())
    }

    fn arguments(&mut self) -> Result<std::ops::Range<u32>, Located> {
        self.expect(b'(', "`(`")?;
        let start = count(&self.document.arguments);
        while self.lexer.token != Token::Symbol(b')') {
            let offset = self.lexer.offset;
            let mut name = None;
            let value = count(&self.document.values);
            if let Token::Name(word) = self.lexer.token {
                if let Some(constant) = constant(word) {
                    self.lexer.advance()?;
                    self.push(constant, offset);
                } else {
                    name = Some(word);
                    self.lexer.advance()?;
                    self.expect(b'=', "`=`")?;
                    self.value()?;
                }
            } else {
                self.value()?;
            }
            self.document.arguments.push(Argument { name, value });
            match self.lexer.token {
                Token::Symbol(b',') => self.lexer.advance()?,
                Token::Symbol(b')') => {}
                Token::Name(_)
                | Token::Number(_)
                | Token::Text { .. }
                | Token::Symbol(_)
                | Token::End => {
                    return Err(self.lexer.unexpected("`,` or `)`"));
                }
            }
        }
        self.lexer.advance()?;
        Ok(start..count(&self.document.arguments))
    }

    fn value(&mut self) -> Result<(), Located> {
        let mut open: Vec<u32> = Vec::new();
        loop {
            let offset = self.lexer.offset;
            match self.lexer.token {
                Token::Symbol(b'[') => {
                    open.push(count(&self.document.values));
                    self.push(Value::Vector { end: 0 }, offset);
                    self.lexer.advance()?;
                    continue;
                }
                // An empty vector, or a comma before the bracket.
                Token::Symbol(b']') if !open.is_empty() => {}
                Token::Name(_)
                | Token::Number(_)
                | Token::Text { .. }
                | Token::Symbol(_)
                | Token::End => {
                    let value = self.scalar()?;
                    self.push(value, offset);
                }
            }
            loop {
                let Some(&vector) = open.last() else { return Ok(()) };
                match self.lexer.token {
                    Token::Symbol(b',') => {
                        self.lexer.advance()?;
                        break;
                    }
                    Token::Symbol(b']') => {
                        let end = count(&self.document.values);
                        self.document.values[vector as usize] = Value::Vector { end };
                        open.pop();
                        self.lexer.advance()?;
                    }
                    Token::Name(_)
                    | Token::Number(_)
                    | Token::Text { .. }
                    | Token::Symbol(_)
                    | Token::End => {
                        return Err(self.lexer.unexpected("`,` or `]`"));
                    }
                }
            }
        }
    }

    fn scalar(&mut self) -> Result<Value, Located> {
        let mut sign = None;
        while let Token::Symbol(b @ (b'-' | b'+')) = self.lexer.token {
            let flip = if b == b'-' { -1.0 } else { 1.0 };
            sign = Some(sign.unwrap_or(1.0) * flip);
            self.lexer.advance()?;
        }
        let value = match self.lexer.token {
            Token::Number(number) => Some(Value::Number(number)),
            Token::Text { start, end } => Some(Value::Text { start, end }),
            Token::Name(word) => constant(word),
            Token::Symbol(_) | Token::End => None,
        };
        let value = match (value, sign) {
            (Some(Value::Number(number)), _) => {
                Value::Number(sign.unwrap_or(1.0) * number)
            }
            (Some(value), None) => value,
            (_, Some(_)) => return Err(self.lexer.unexpected("a number")),
            (None, None) => return Err(self.lexer.unexpected("a value")),
        };
        self.lexer.advance()?;
        Ok(value)
    }

    fn push(&mut self, value: Value, offset: u32) {
        self.document.values.push(value);
        self.document.offsets.push(offset);
    }

    fn expect(&mut self, symbol: u8, expected: &str) -> Result<(), Located> {
        if self.lexer.token != Token::Symbol(symbol) {
            return Err(self.lexer.unexpected(expected));
        }
        self.lexer.advance()
    }

    /// The place of the token under the cursor.
    fn place(&mut self) -> Place {
        let to = self.lexer.offset;
        let text = &self.document.text[self.counted as usize..to as usize];
        advance(&mut self.place, text);
        self.counted = to;
        self.place
    }
}

fn constant(word: &str) -> Option<Value> {
    match word {
        "true" => Some(Value::Bool(true)),
        "false" => Some(Value::Bool(false)),
        "undef" => Some(Value::Undef),
        "inf" => Some(Value::Number(f64::INFINITY)),
        "nan" => Some(Value::Number(f64::NAN)),
        _ => None,
    }
}

/// How many there are; fewer than bytes, of which there are fewer than 2^32.
fn count<T>(list: &[T]) -> u32 {
    u32::try_from(list.len()).unwrap_or(u32::MAX)
}
