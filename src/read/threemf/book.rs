//! What is known of an archive while it is read.

use std::collections::{BTreeMap, HashMap};

use crate::solid::Solid;

/// The objects read so far, and what is made of them.
#[derive(Default)]
pub(super) struct Book {
    /// The indices of the parts that were read, by their names.
    pub(super) parts: HashMap<String, usize>,
    /// The objects by the indices of their parts and their numbers there.
    pub(super) objects: HashMap<(usize, u32), Object>,
    /// What the build lists.
    pub(super) built: Vec<Solid>,
    /// The meshes of all objects.
    pub(super) meshes: Vec<Solid>,
    /// How long the unit of the first part is, in millimetres. It holds for the others.
    pub(super) unit: f64,
    /// How many meshes had to be turned.
    pub(super) turned: usize,
    /// Of which kinds objects were left out, and how many.
    pub(super) left_out: BTreeMap<Role, usize>,
    /// Whether a component or an item is anywhere but where it is written.
    pub(super) is_moved: bool,
}

/// An object.
pub(super) struct Object {
    pub(super) solid: Solid,
    pub(super) role: Role,
}

/// What an object is for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Role {
    /// A part of the model.
    #[default]
    Model,
    /// What holds up other objects while they are printed.
    Support,
    /// A surface, which has no inside.
    Surface,
    /// What only programs know, such as regions with other settings.
    Other,
}

impl Role {
    /// What the attribute `type` stands for.
    pub(super) fn of(kind: &str) -> Option<Self> {
        Some(match kind {
            "model" => Self::Model,
            "support" | "solidsupport" => Self::Support,
            "surface" => Self::Surface,
            "other" => Self::Other,
            _ => return None,
        })
    }

    fn name(self) -> &'static str {
        match self {
            Self::Model => "model",
            Self::Support => "support",
            Self::Surface => "surface",
            Self::Other => "other",
        }
    }
}

impl Book {
    /// What there is to say.
    pub(super) fn warnings(&self) -> Vec<String> {
        let mut said = Vec::new();
        if self.turned > 0 {
            let count = self.turned;
            said.push(format!("{count} meshes were inside out and have been turned"));
        }
        for (role, count) in &self.left_out {
            let name = role.name();
            said.push(format!("objects of type `{name}` are left out {count} times"));
        }
        said
    }
}
