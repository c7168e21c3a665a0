//! Walks the statements and makes shapes from the leaves up.

use super::super::error::{Located, ReadErrorKind};
use super::super::words::quoted;
use super::arguments::Call;
use super::elsewhere;
use super::evaluate::Reading;
use super::marks::{Aside, Marked};
use super::node::{Node, Shape, node};
use super::value::{Document, Statement};

/// A statement whose braces are open.
struct Frame {
    node: Node,
    statement: usize,
    children: Vec<Shape>,
    marked: Marked,
    /// Whether only the hull of its children matters.
    hulls: bool,
    /// Whether its children become polygons or polyhedra.
    facets: bool,
}

/// The shapes of the outermost statements in a range, and what is marked in it.
pub(super) fn shapes(
    document: &Document<'_>,
    next: usize,
    end: usize,
    reading: &mut Reading<'_>,
) -> Result<(Vec<Shape>, Marked), Located> {
    let mut walk = Walk {
        document,
        next,
        end,
        open: Vec::new(),
        outermost: Vec::new(),
        marked: Marked::default(),
    };
    loop {
        match walk.step(reading) {
            Ok(true) => {}
            Ok(false) => return Ok((walk.outermost, walk.marked)),
            Err(error) => match reading.aside.take() {
                Some(aside) => walk.leave_aside(aside, &error, reading),
                None => return Err(error),
            },
        }
    }
}

/// How far the statements are made.
struct Walk<'a> {
    document: &'a Document<'a>,
    /// The statement that is opened next.
    next: usize,
    end: usize,
    open: Vec<Frame>,
    outermost: Vec<Shape>,
    marked: Marked,
}

impl Walk<'_> {
    /// Closes a statement, or else opens one; `false` after the last.
    fn step(&mut self, reading: &mut Reading<'_>) -> Result<bool, Located> {
        let document = self.document;
        let next = self.next;
        let ends = |f: &mut Frame| document.statements[f.statement].end as usize <= next;
        if let Some(frame) = self.open.pop_if(ends) {
            self.close(frame, reading)?;
            return Ok(true);
        }
        if next >= self.end {
            return Ok(false);
        }
        let statement = &document.statements[next];
        let modifiers = statement.modifiers;
        // What takes no part in the model may be anything, even what cannot be read.
        if modifiers.disabled || (modifiers.background && !reading.options.marks) {
            self.next = statement.end as usize;
            return Ok(true);
        }
        if modifiers.background && reading.aside.is_none() {
            reading.aside = Some(reading.set_aside(next));
        }
        let Some(node) = node(statement.name) else {
            let what = quoted(statement.name.as_bytes());
            if !elsewhere::is_known(statement.name) {
                let kind = ReadErrorKind::Unsupported(what);
                return Err(Located::at(statement.place, kind));
            }
            let shape = elsewhere::evaluated(document, next, what, reading)?;
            self.next = statement.end as usize;
            self.put(next, shape, Marked::default(), reading);
            return Ok(true);
        };
        let outer = self.around(statement);
        let hulls = match statement.name {
            "hull" => true,
            "group" | "union" | "multmatrix" | "color" | "render" => {
                outer.is_some_and(|frame| frame.hulls)
            }
            _ => false,
        };
        let facets = match statement.name {
            "minkowski" | "offset" | "projection" => true,
            _ => outer.is_some_and(|frame| frame.facets),
        };
        let (children, marked) = (Vec::new(), Marked::default());
        self.open.push(Frame { node, statement: next, children, marked, hulls, facets });
        self.next += 1;
        Ok(true)
    }

    /// The statement around one that shapes what is made of it.
    fn around(&self, statement: &Statement<'_>) -> Option<&Frame> {
        self.open.last().filter(|_| !statement.modifiers.background)
    }

    /// Makes a shape of a statement whose children are made.
    fn close(&mut self, frame: Frame, reading: &mut Reading<'_>) -> Result<(), Located> {
        let Frame { node, statement: index, children, mut marked, .. } = frame;
        let document = self.document;
        let statement = &document.statements[index];
        let call = Call { document, statement, parameters: node.parameters };
        call.warn_of_unknown(reading);
        let outer = self.around(statement);
        reading.is_hulled = outer.is_some_and(|frame| frame.hulls);
        reading.is_faceted = outer.is_some_and(|frame| frame.facets);
        let shape = match (node.make)(&call, children, reading) {
            Err(Located { kind: ReadErrorKind::Unsupported(what), .. }) => {
                elsewhere::evaluated(document, index, what, reading)?
            }
            made => made?,
        };
        reading.model.counts.fine += usize::from(reading.is_fine.take());
        marked.map(&call)?;
        self.put(index, shape, marked, reading);
        Ok(())
    }

    /// Hands what a statement made, and what is marked in it, to the one around it.
    fn put(
        &mut self,
        index: usize,
        shape: Shape,
        inner: Marked,
        reading: &mut Reading<'_>,
    ) {
        let statement = &self.document.statements[index];
        let (children, marked) = match self.open.last_mut() {
            Some(frame) => (&mut frame.children, &mut frame.marked),
            None => (&mut self.outermost, &mut self.marked),
        };
        if reading.options.marks {
            marked.add(inner, statement, &shape);
        }
        if !statement.modifiers.background {
            children.push(shape);
        } else if let Some(aside) = reading.aside.take_if(|a| a.statement == index) {
            reading.put_back(aside);
        }
    }

    /// Goes on behind a statement after `%` that cannot be made.
    fn leave_aside(&mut self, aside: Aside, error: &Located, reading: &mut Reading<'_>) {
        self.open.retain(|frame| frame.statement < aside.statement);
        let statement = &self.document.statements[aside.statement];
        self.next = statement.end as usize;
        let message = format!("what `%` shows is left out: {}", error.kind);
        reading.warn(error.place.unwrap_or(statement.place), message);
        reading.put_back(aside);
    }
}
