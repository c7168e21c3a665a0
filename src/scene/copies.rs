//! Equal meshes are indexed once.

use std::collections::HashMap;
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use std::sync::Arc;

use crate::mesh::Mesh;
use crate::shape::IndexedMesh;

/// The meshes of a solid in the making.
#[derive(Default)]
pub(super) struct Meshes {
    by_address: HashMap<*const Mesh, Arc<IndexedMesh>>,
    by_content: HashMap<u64, Vec<Known>>,
}

struct Known {
    mesh: Arc<Mesh>,
    indexed: Arc<IndexedMesh>,
}

impl Meshes {
    /// A mesh with its hierarchy: the same for all that have equal points and faces, whether
    /// or not they are one in memory. A file that says a polyhedron twice has it twice.
    pub(super) fn indexed(&mut self, mesh: &Arc<Mesh>) -> Arc<IndexedMesh> {
        let of_content = || {
            let alike = self.by_content.entry(hash(mesh)).or_default();
            if let Some(known) = alike.iter().find(|known| known.mesh == *mesh) {
                return known.indexed.clone();
            }
            let indexed = Arc::new(IndexedMesh::new(mesh.clone()));
            alike.push(Known { mesh: mesh.clone(), indexed: indexed.clone() });
            indexed
        };
        self.by_address.entry(Arc::as_ptr(mesh)).or_insert_with(of_content).clone()
    }
}

/// Zero has a sign that equality does not see, so it is taken off.
fn hash(mesh: &Mesh) -> u64 {
    let mut hasher = DefaultHasher::new();
    mesh.faces().hash(&mut hasher);
    for point in mesh.points() {
        point.to_array().map(|x| (x + 0.0).to_bits()).hash(&mut hasher);
    }
    hasher.finish()
}
