//! Any bytes as a tree and rays at it, compared with exact arithmetic: boxes, half-spaces and
//! meshes on a lattice with whole numbers, quadrics under maps with numbers of 200 bits.

#![no_main]

mod bytes;
mod digits;
mod lattice;
#[expect(dead_code, reason = "tests ask for more")]
#[path = "../../../tests/oracle/mod.rs"]
mod oracle;
#[expect(dead_code, reason = "tests ask for more")]
#[path = "../../../tests/support/mod.rs"]
mod support;

use libfuzzer_sys::arbitrary::{Arbitrary, Result, Unstructured};
use libfuzzer_sys::fuzz_target;
use oracle::compare::compare;
use oracle::equal::{assert_equal_but_for_slivers, assert_equal_lists};
use oracle::lattice::Lattice;
use oracle::placed::placed;
use solidray::Ray;
use support::leaf::Leaf;
use support::model::Model;
use support::scene;

/// A tree and what it is asked.
#[derive(Debug)]
struct Case {
    oracle: Oracle,
    model: Model,
    rays: Vec<Ray>,
}

/// What a case is compared with.
#[derive(Debug)]
enum Oracle {
    Lattice,
    Digits,
}

impl<'a> Arbitrary<'a> for Case {
    fn arbitrary(bytes: &mut Unstructured<'a>) -> Result<Self> {
        let oracle =
            if bytes::one_in_two(bytes)? { Oracle::Lattice } else { Oracle::Digits };
        let (model, rays) = match oracle {
            Oracle::Lattice => lattice::case(bytes)?,
            Oracle::Digits => digits::case(bytes)?,
        };
        Ok(Self { oracle, model, rays })
    }
}

fuzz_target!(|case: Case| {
    let Case { oracle, model, rays } = case;
    let scene = scene(&model.solid());
    match oracle {
        Oracle::Lattice => {
            let lattice = Lattice::new(&model);
            let is_mesh = |leaf: &Leaf| matches!(leaf, Leaf::Mesh(_));
            let has_mesh = model.leaves().iter().any(|(leaf, _)| is_mesh(leaf));
            for ray in &rays {
                if has_mesh {
                    assert_equal_but_for_slivers(&scene, &model, &lattice, ray);
                } else {
                    assert_equal_lists(&scene, &model, &lattice, ray);
                }
            }
        }
        Oracle::Digits => {
            let leaves = placed(&model);
            for ray in &rays {
                compare(&model, &leaves, &scene, ray);
            }
        }
    }
});
