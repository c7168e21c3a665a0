//! The parts of a solid: what shares a name and a colour.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use glam::DAffine3;

use crate::color::Color;
use crate::op::Op;
use crate::solid::{Kind, Place, Solid, Tag};

/// What leaves are of, if they have a name or a colour.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Part {
    /// The name given by [`Solid::named`].
    pub name: Option<Arc<str>>,
    /// The colour given by [`Solid::colored`].
    pub color: Option<Color>,
}

impl Part {
    /// What equal parts have in common.
    pub(crate) fn key(&self) -> (Option<Arc<str>>, Option<[u32; 4]>) {
        (self.name.clone(), self.color.map(|c| c.rgba.map(f32::to_bits)))
    }

    /// What it is below a tag: the innermost name and the outermost colour hold.
    #[must_use]
    pub(crate) fn tagged(mut self, tag: &Tag) -> Self {
        match tag {
            Tag::Name(name) => self.name = Some(name.clone()),
            Tag::Color(color) => self.color = self.color.or(Some(*color)),
            Tag::Place(_) | Tag::Outline => {}
        }
        self
    }
}

/// What a piece of the tree is within, and what is around that.
struct Around<'a> {
    step: Step<'a>,
    outer: Option<usize>,
}

enum Step<'a> {
    Mapped(&'a DAffine3),
    Tagged(&'a Tag),
    /// Before other operands.
    With(Op, &'a [Solid]),
}

impl Solid {
    /// The solid part by part, in the order in which they first occur.
    ///
    /// Material is of the part that it was made of: what is subtracted from something, or
    /// what that is intersected with, does not change its part. The union of all parts is the solid;
    /// parts may overlap, as their operands do.
    pub fn parts(&self) -> Vec<(Part, Self)> {
        let tagged = self.with_parts();
        let mut around: Vec<Around<'_>> = Vec::new();
        let mut found: Vec<(Part, Vec<Self>)> = Vec::new();
        let mut numbers = HashMap::new();
        let mut open = vec![(self, Part::default(), None)];
        while let Some((solid, part, outer)) = open.pop() {
            let (kind, children) = (solid.kind(), solid.children());
            if !tagged.contains(&solid.address()) {
                let piece = put_back(solid.clone(), outer, &around);
                let number = *numbers.entry(part.key()).or_insert(found.len());
                if number == found.len() {
                    found.push((part, Vec::new()));
                }
                found[number].1.push(piece);
                continue;
            }
            let mut within = |step| {
                around.push(Around { step, outer });
                Some(around.len() - 1)
            };
            match (kind, children) {
                (Kind::Boolean(Op::Union), children) => {
                    let each = children.iter().rev();
                    open.extend(each.map(|child| (child, part.clone(), outer)));
                }
                (Kind::Boolean(op), [first, rest @ ..]) => {
                    open.push((first, part, within(Step::With(*op, rest))));
                }
                (Kind::Mapped(map), [child]) => {
                    open.push((child, part, within(Step::Mapped(map))));
                }
                (Kind::Tagged(tag), [child]) => {
                    let part = part.tagged(tag);
                    open.push((child, part, within(Step::Tagged(tag))));
                }
                _ => {}
            }
        }
        let whole = |(part, mut pieces): (Part, Vec<Self>)| match pieces.len() {
            1 => (part, pieces.swap_remove(0)),
            _ => (part, Self::boolean(Op::Union, pieces)),
        };
        if found.len() == 1 {
            return vec![(found.swap_remove(0).0, self.clone())];
        }
        found.into_iter().map(whole).collect()
    }

    /// What is of some of its [parts](Self::parts): those that `keep` says. Together with what is of
    /// the others it is the solid.
    #[must_use]
    pub fn of_parts(&self, keep: impl Fn(&Part) -> bool) -> Self {
        let tagged = self.with_parts();
        // By address and part, because a colour may be that of what is around.
        let mut done = HashMap::new();
        let mut open = vec![(self, Part::default(), false)];
        while let Some((solid, part, seen)) = open.pop() {
            let this = (solid.address(), part.key());
            if done.contains_key(&this) {
                continue;
            }
            if !tagged.contains(&solid.address()) {
                let kept = if keep(&part) { Some(solid.clone()) } else { None };
                done.insert(this, kept);
                continue;
            }
            let kind = solid.kind();
            let is_union =
                !matches!(kind, Kind::Boolean(Op::Intersection | Op::Difference));
            let first = if is_union { solid.children().len() } else { 1 };
            let (pieces, rest) =
                solid.children().split_at(first.min(solid.children().len()));
            let mut below = part.clone();
            if let Kind::Tagged(tag) = kind {
                below = below.tagged(tag);
            }
            if !seen {
                open.push((solid, part, true));
                open.extend(pieces.iter().map(|piece| (piece, below.clone(), false)));
                continue;
            }
            let kept = |piece: &Self| done[&(piece.address(), below.key())].clone();
            let mut kept = pieces.iter().filter_map(kept).peekable();
            let found = kept.peek().is_some().then(|| match kind {
                Kind::Boolean(op) => Self::boolean(*op, kept.chain(rest.iter().cloned())),
                Kind::Mapped(map) => Self::boolean(Op::Union, kept).mapped(**map),
                Kind::Tagged(tag) => Self::boolean(Op::Union, kept).tagged(tag.clone()),
                Kind::Primitive(_) | Kind::Mesh(_) => Self::boolean(Op::Union, kept),
            });
            done.insert(this, found);
        }
        let whole = done.remove(&(self.address(), Part::default().key()));
        whole.flatten().unwrap_or_else(Self::empty)
    }

    /// The operands of the topmost union that has several, in the order of the file, and where each
    /// stands, or the first leaf in it, if that is known; the solid itself if there is no such union
    /// at the top, or only one within what counts as one leaf by [`Solid::as_outline`].
    pub fn objects(&self) -> Vec<(Option<Place>, Self)> {
        let mut around: Vec<Around<'_>> = Vec::new();
        let (mut top, mut outer) = (self, None);
        loop {
            let step = match (top.kind(), top.children()) {
                (Kind::Mapped(map), [_]) => Step::Mapped(map),
                (Kind::Tagged(Tag::Outline), _) => {
                    return vec![(self.place(), self.clone())];
                }
                (Kind::Tagged(tag), [_]) => Step::Tagged(tag),
                // One operand is the same under any operator.
                (Kind::Boolean(_), [_]) => Step::With(Op::Union, &[]),
                (Kind::Boolean(Op::Union), children @ [_, _, ..]) => {
                    let object = |child: &Self| {
                        (child.place(), put_back(child.clone(), outer, &around))
                    };
                    return children.iter().map(object).collect();
                }
                _ => return vec![(self.place(), self.clone())],
            };
            around.push(Around { step, outer });
            (top, outer) = (&top.children()[0], Some(around.len() - 1));
        }
    }

    /// Where it stands in its file, or the first in it that says so.
    fn place(&self) -> Option<Place> {
        let mut at = self;
        loop {
            if let Kind::Tagged(Tag::Place(place)) = at.kind() {
                return Some(*place);
            }
            at = at.children().first()?;
        }
    }

    /// The nodes, by their addresses, from which material can have a name or a colour that it was
    /// given below.
    fn with_parts(&self) -> HashSet<usize> {
        let mut known: HashMap<usize, bool> = HashMap::new();
        let mut open = vec![(self, false)];
        while let Some((solid, seen)) = open.pop() {
            if !seen && known.contains_key(&solid.address()) {
                continue;
            }
            let below = match solid.kind() {
                Kind::Boolean(Op::Union) | Kind::Mapped(_) | Kind::Tagged(_) => {
                    solid.children()
                }
                Kind::Boolean(_) => solid.children().get(..1).unwrap_or(&[]),
                Kind::Primitive(_) | Kind::Mesh(_) => &[],
            };
            if !seen {
                open.push((solid, true));
                open.extend(below.iter().map(|child| (child, false)));
                continue;
            }
            let tag = matches!(solid.kind(), Kind::Tagged(Tag::Name(_) | Tag::Color(_)));
            let has = tag
                || below.iter().any(|child| known.get(&child.address()) == Some(&true));
            known.insert(solid.address(), has);
        }
        known.into_iter().filter(|(_, has)| *has).map(|(address, _)| address).collect()
    }
}

/// A piece with all that is around it.
fn put_back(mut piece: Solid, mut outer: Option<usize>, around: &[Around<'_>]) -> Solid {
    while let Some(i) = outer {
        piece = match &around[i].step {
            Step::Mapped(map) => piece.mapped(**map),
            Step::Tagged(tag) => piece.tagged((*tag).clone()),
            Step::With(op, rest) => {
                let operands = std::iter::once(piece).chain(rest.iter().cloned());
                Solid::boolean(*op, operands)
            }
        };
        outer = around[i].outer;
    }
    piece
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scene;
    use glam::DVec3;

    fn colored(solid: Solid, red: f32) -> Solid {
        solid.colored(Color::rgb(red, 0.0, 0.0))
    }

    fn colors(solid: &Solid) -> Vec<Option<f32>> {
        solid.parts().iter().map(|(part, _)| part.color.map(|c| c.rgba[0])).collect()
    }

    #[test]
    fn material_is_of_the_part_that_it_was_made_of() {
        let (a, b) = (colored(Solid::ball(1.0), 0.1), colored(Solid::ball(2.0), 0.2));
        let plain = Solid::cuboid(DVec3::ONE);
        assert_eq!(colors(&plain), [None]);
        assert_eq!(colors(&(a.clone() - b.clone())), [Some(0.1)]);
        assert_eq!(colors(&(a.clone() & b.clone())), [Some(0.1)]);
        let both = a.clone() + (plain.clone() + b.clone()).translated(DVec3::X);
        assert_eq!(colors(&(both.clone() - a.clone())), [Some(0.1), None, Some(0.2)]);
        // The outermost colour holds, and equal ones are one part.
        assert_eq!(colors(&colored(both, 0.7)), [Some(0.7)]);
        assert_eq!(colors(&(a.clone() + (b + a))), [Some(0.1), Some(0.2)]);
        assert_eq!(colors(&Solid::boolean(Op::Intersection, [])), [None]);
    }

    #[test]
    fn what_is_of_parts_is_the_solid_again() {
        let (a, b) = (colored(Solid::ball(1.0), 0.1), colored(Solid::ball(1.5), 0.2));
        let plain = Solid::cuboid(DVec3::ONE).translated(DVec3::Y);
        let both = a.clone() + (plain.clone() + b.clone()).translated(DVec3::X);
        let solid = (both.clone() - a.clone().translated(DVec3::NEG_X))
            + colored(both.clone() & Solid::cuboid(DVec3::splat(1.5)), 0.3)
            + both.translated(DVec3::Z);
        let inside = |solid: &Solid| {
            let scene = Scene::compile(solid).expect("a solid");
            let at = |i: i32| {
                DVec3::new(f64::from(i % 11), f64::from(i / 11 % 11), f64::from(i / 121))
            };
            (0..1331).map(|i| scene.contains(0.43 * at(i) - 2.0)).collect::<Vec<_>>()
        };
        for (part, piece) in solid.parts() {
            let [of_it, of_others] = [true, false].map(|is| {
                inside(&solid.of_parts(|other| (other.key() == part.key()) == is))
            });
            assert_eq!(of_it, inside(&piece), "{part:?}");
            let whole: Vec<bool> =
                of_it.iter().zip(&of_others).map(|(a, b)| *a || *b).collect();
            assert_eq!(whole, inside(&solid), "{part:?}");
            assert!(of_it.contains(&true) && of_it != of_others);
        }
        assert!(inside(&solid.of_parts(|_| false)).iter().all(|is| !is));
    }

    #[test]
    fn objects_are_the_operands_of_the_topmost_union() {
        let place = |line| Place { line, column: 1 };
        let (a, b) = (Solid::ball(1.0).placed(place(3)), Solid::cuboid(DVec3::ONE));
        assert_eq!(a.objects().len(), 1);
        assert_eq!(a.objects()[0].0, Some(place(3)));
        let both = Solid::boolean(Op::Union, [a.clone() + b.clone()]);
        let objects = both.clone().translated(DVec3::X).objects();
        let places: Vec<_> = objects.iter().map(|(place, _)| *place).collect();
        assert_eq!(places, [Some(place(3)), None]);
        for (_, object) in &objects {
            assert!(matches!(object.kind(), Kind::Mapped(_)), "it is moved as all are");
        }
        assert_eq!(both.clone().as_outline().objects().len(), 1);
        assert_eq!((both - a).objects().len(), 1);
    }

    #[test]
    fn long_chains_of_parts_do_not_grow_the_stack() {
        let mut chain = colored(Solid::ball(1.0), 0.0);
        for i in 0..300 {
            let next = colored(Solid::ball(1.0), if i % 2 == 0 { 0.5 } else { 0.0 });
            chain = (chain + next).translated(DVec3::X) - Solid::ball(0.5);
        }
        assert_eq!(chain.parts().len(), 2);
        let mut deep = colored(Solid::ball(1.0), 0.0);
        for _ in 0..200_000 {
            deep = deep - Solid::ball(0.5);
        }
        assert_eq!(deep.parts().len(), 1);
    }
}
