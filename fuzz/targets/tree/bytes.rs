//! Numbers and trees from bytes.

use glam::{DAffine3, DMat3, DVec3};
use libfuzzer_sys::arbitrary::{Result, Unstructured};
use solidray::Op;

use crate::support::model::Model;

/// The most leaves of a tree.
const LEAVES: usize = 10;

/// How deep a tree can be.
const DEPTH: usize = 4;

/// What trees are made of.
pub(crate) struct Parts {
    pub(crate) leaf: fn(&mut Unstructured) -> Result<Model>,
    pub(crate) map: fn(&mut Unstructured) -> Result<DAffine3>,
}

impl Parts {
    /// A tree; one leaf when there are no more bytes.
    pub(crate) fn tree(&self, bytes: &mut Unstructured) -> Result<Model> {
        self.subtree(bytes, DEPTH, &mut Vec::new())
    }

    /// A tree, given the leaves that there are before it.
    fn subtree(
        &self,
        bytes: &mut Unstructured,
        depth: usize,
        leaves: &mut Vec<Model>,
    ) -> Result<Model> {
        let kind = bytes.int_in_range(0..=7)?;
        if depth == 0 || leaves.len() >= LEAVES || kind <= 2 {
            return self.leaf(bytes, leaves);
        }
        if kind == 3 {
            let map = (self.map)(bytes)?;
            return Ok(self.subtree(bytes, depth - 1, leaves)?.mapped(map));
        }
        let op = *bytes.choose(&[Op::Union, Op::Intersection, Op::Difference])?;
        let children = (0..bytes.int_in_range(1..=4)?)
            .map(|_| self.subtree(bytes, depth - 1, leaves))
            .collect::<Result<_>>()?;
        Ok(Model::Boolean(op, children))
    }

    /// A new leaf, or one that is there already.
    fn leaf(&self, bytes: &mut Unstructured, leaves: &mut Vec<Model>) -> Result<Model> {
        let is_new = leaves.is_empty() || bytes.int_in_range(0..=3)? != 1;
        let leaf =
            if is_new { (self.leaf)(bytes)? } else { bytes.choose(leaves)?.clone() };
        leaves.push(leaf.clone());
        Ok(leaf)
    }
}

/// A few of something: as many as the bytes are enough for.
pub(crate) fn some<T>(
    bytes: &mut Unstructured,
    most: usize,
    mut one: impl FnMut(&mut Unstructured) -> Result<T>,
) -> Result<Vec<T>> {
    let mut all = vec![one(bytes)?];
    while all.len() < most && !bytes.is_empty() {
        all.push(one(bytes)?);
    }
    Ok(all)
}

pub(crate) fn one_in_two(bytes: &mut Unstructured) -> Result<bool> {
    Ok(bytes.int_in_range(0..=1)? == 0)
}

/// A whole number from −`reach` to `reach`.
pub(crate) fn small(bytes: &mut Unstructured, reach: i8) -> Result<f64> {
    Ok(f64::from(bytes.int_in_range(-reach..=reach)?))
}

/// Three of a kind.
pub(crate) fn three(
    bytes: &mut Unstructured,
    one: impl Fn(&mut Unstructured) -> Result<f64>,
) -> Result<DVec3> {
    Ok(DVec3::new(one(bytes)?, one(bytes)?, one(bytes)?))
}

/// One of the 48 maps of the cube onto itself.
pub(crate) fn symmetry(bytes: &mut Unstructured) -> Result<DMat3> {
    let orders = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    let [x, y, z] = bytes.choose(&orders)?.map(|i: usize| DVec3::AXES[i]);
    let signs = three(bytes, |bytes| Ok(if one_in_two(bytes)? { 1.0 } else { -1.0 }))?;
    Ok(DMat3::from_cols(signs.x * x, signs.y * y, signs.z * z))
}
