//! The text of a part: objects, and what is built of them.

use std::collections::HashMap;

use glam::{DAffine3, DVec3};

use super::super::error::{Located, ReadErrorKind};
use super::super::faces::Faces;
use super::super::load::Budget;
use super::super::words::quoted;
use super::super::xml::{Element, Tag, Xml};
use super::book::{Book, Object, Role};
use super::header::Header;
use super::package::Package;
use super::union;
use super::value::{hex, number, transform, whole};
use crate::color::Color;
use crate::solid::Solid;

/// What is inside which element.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Within {
    Document,
    Model,
    Resources,
    Materials,
    Object,
    Mesh,
    Vertices,
    Triangles,
    Components,
    Build,
    /// What is not looked at.
    Elsewhere,
}

/// An object that is being read.
#[derive(Default)]
struct Open {
    /// The byte where it begins.
    at: usize,
    id: u32,
    role: Role,
    name: String,
    color: Option<Color>,
    faces: Faces,
    /// Whether there is a mesh, even if it has no faces.
    is_mesh: bool,
    components: Vec<Solid>,
}

/// A part that is being read.
struct Reading<'r, 'a> {
    package: &'r mut Package<'a>,
    budget: &'r mut Budget,
    book: &'r mut Book,
    /// The index of the part, and whether it is the first one.
    part: usize,
    is_first: bool,
    header: Header,
    /// The colours of each group of materials.
    materials: HashMap<u32, Vec<Color>>,
    material: u32,
    object: Open,
}

/// Reads a part, and the parts that it refers to if it is the first one: only that may, so that
/// no more than two are open at a time.
pub(super) fn read(
    package: &mut Package<'_>,
    name: &str,
    is_first: bool,
    budget: &mut Budget,
    book: &mut Book,
) -> Result<(), Located> {
    let bytes = package.part(name, budget).map_err(Located::nowhere)?;
    let part = book.parts.len();
    book.parts.insert(name.to_owned(), part);
    let reading = Reading {
        package,
        budget,
        book,
        part,
        is_first,
        header: Header::default(),
        materials: HashMap::new(),
        material: 0,
        object: Open::default(),
    };
    reading.run(&bytes).map_err(|error| error.within(name))
}

impl Reading<'_, '_> {
    fn run(mut self, bytes: &[u8]) -> Result<(), Located> {
        let mut xml = Xml::new(bytes)?;
        let mut open = vec![Within::Document];
        let mut is_empty = true;
        while let Some(tag) = xml.next()? {
            match tag {
                Tag::Open(element) => {
                    let outer = open.last().copied().unwrap_or(Within::Elsewhere);
                    open.push(self.open(&element, outer)?);
                    is_empty = false;
                }
                Tag::Close if open.pop() == Some(Within::Object) => self.close(&xml)?,
                Tag::Close => {}
            }
        }
        if is_empty {
            return Err(Located::syntax(xml.place(), "`model`", "the end of the file"));
        }
        Ok(())
    }

    /// What an element says, and what it is to those in it.
    fn open(&mut self, element: &Element<'_>, outer: Within) -> Result<Within, Located> {
        if outer == Within::Document {
            self.header = Header::of(element)?;
            if self.is_first {
                self.book.unit = self.header.unit;
            }
            return Ok(Within::Model);
        }
        let name = element.name();
        let (prefix, local) = name.split_once(':').unwrap_or(("", name));
        if prefix != self.header.core {
            return Ok(Within::Elsewhere);
        }
        Ok(match (outer, local) {
            (Within::Model, "resources") => Within::Resources,
            (Within::Model, "build") => Within::Build,
            (Within::Resources, "basematerials") => {
                let mut id = None;
                element.attributes(|name, value| {
                    if name == "id" {
                        id = Some(whole(element, &value)?);
                    }
                    Ok(())
                })?;
                self.material = id.ok_or_else(|| element.without("id"))?;
                Within::Materials
            }
            (Within::Materials, "base") => {
                self.base(element)?;
                Within::Elsewhere
            }
            (Within::Resources, "object") => {
                self.object(element)?;
                Within::Object
            }
            (Within::Object, "mesh") => {
                self.object.is_mesh = true;
                Within::Mesh
            }
            (Within::Object, "components") => Within::Components,
            (Within::Mesh, "vertices") => Within::Vertices,
            (Within::Mesh, "triangles") => Within::Triangles,
            (Within::Vertices, "vertex") => {
                self.vertex(element)?;
                Within::Elsewhere
            }
            (Within::Triangles, "triangle") => {
                self.triangle(element)?;
                Within::Elsewhere
            }
            (Within::Components, "component") => {
                if let Some(solid) = self.placed(element)? {
                    self.object.components.push(solid);
                }
                Within::Elsewhere
            }
            (Within::Build, "item") => {
                // The build of another part is not that of the archive.
                if self.is_first
                    && let Some(solid) = self.placed(element)?
                {
                    self.book.built.push(solid);
                }
                Within::Elsewhere
            }
            _ => Within::Elsewhere,
        })
    }

    fn base(&mut self, element: &Element<'_>) -> Result<(), Located> {
        let mut color = Color::rgb(1.0, 1.0, 1.0);
        element.attributes(|name, value| {
            if name == "displaycolor" {
                let known = "a colour as `#rrggbb` or `#rrggbbaa`";
                color = hex(&value).ok_or_else(|| element.unexpected(known, &value))?;
            }
            Ok(())
        })?;
        self.materials.entry(self.material).or_default().push(color);
        Ok(())
    }

    fn object(&mut self, element: &Element<'_>) -> Result<(), Located> {
        let (mut id, mut group, mut index) = (None, None, None);
        let mut open = Open { at: element.at(), ..Open::default() };
        element.attributes(|name, value| {
            match name {
                "id" => id = Some(whole(element, &value)?),
                "name" => open.name = value.into_owned(),
                "type" => {
                    open.role = Role::of(&value).ok_or_else(|| {
                        let known = "a type of `model`, `support`, `solidsupport`, `surface` or `other`";
                        element.unexpected(known, &value)
                    })?;
                }
                "pid" => group = Some(whole(element, &value)?),
                "pindex" => index = Some(whole(element, &value)?),
                _ => {}
            }
            Ok(())
        })?;
        open.id = id.ok_or_else(|| element.without("id"))?;
        if self.book.objects.contains_key(&(self.part, open.id)) {
            let found = open.id.to_string();
            return Err(element.unexpected("an id that no other object has", &found));
        }
        // Groups of other kinds than base materials are of extensions.
        let colors = group.and_then(|group| self.materials.get(&group));
        open.color = colors.and_then(|c| c.get(index.unwrap_or(0) as usize)).copied();
        self.object = open;
        Ok(())
    }

    fn vertex(&mut self, element: &Element<'_>) -> Result<(), Located> {
        let mut point = [None; 3];
        element.attributes(|name, value| {
            let axis = match name {
                "x" => 0,
                "y" => 1,
                "z" => 2,
                _ => return Ok(()),
            };
            point[axis] = Some(number(element, &value)?);
            Ok(())
        })?;
        let [Some(x), Some(y), Some(z)] = point else {
            return Err(element.without("x`, `y` or `z"));
        };
        self.object.faces.points.push(DVec3::new(x, y, z));
        Ok(())
    }

    fn triangle(&mut self, element: &Element<'_>) -> Result<(), Located> {
        let mut corners = [None; 3];
        let count = self.object.faces.points.len();
        element.attributes(|name, value| {
            let corner = match name {
                "v1" => 0,
                "v2" => 1,
                "v3" => 2,
                _ => return Ok(()),
            };
            let index = whole(element, &value)?;
            if index as usize >= count {
                let known = format!("the index of one of {count} vertices");
                return Err(element.unexpected(&known, &value));
            }
            corners[corner] = Some(index);
            Ok(())
        })?;
        let [Some(a), Some(b), Some(c)] = corners else {
            return Err(element.without("v1`, `v2` or `v3"));
        };
        self.object.faces.push([a, b, c]);
        Ok(())
    }

    /// The object that a component or an item places; nothing if it is no part of the model.
    fn placed(&mut self, element: &Element<'_>) -> Result<Option<Solid>, Located> {
        let (mut id, mut map, mut path) = (None, None, None);
        element.attributes(|name, value| {
            match name.split_once(':') {
                None if name == "objectid" => id = Some(whole(element, &value)?),
                None if name == "transform" => map = Some(transform(element, &value)?),
                Some((prefix, "path"))
                    if Some(prefix) == self.header.production.as_deref() =>
                {
                    path = Some(value.into_owned());
                }
                _ => {}
            }
            Ok(())
        })?;
        let id = id.ok_or_else(|| element.without("objectid"))?;
        let part = match path {
            Some(path) => self.other(&path, element)?,
            None => self.part,
        };
        let Some(object) = self.book.objects.get(&(part, id)) else {
            let known = "the id of an object before this";
            return Err(element.unexpected(known, &id.to_string()));
        };
        if object.role != Role::Model {
            *self.book.left_out.entry(object.role).or_default() += 1;
            return Ok(None);
        }
        let solid = object.solid.clone();
        Ok(Some(match map {
            Some(map) if map != DAffine3::IDENTITY => {
                self.book.is_moved = true;
                solid.mapped(map)
            }
            _ => solid,
        }))
    }

    /// The index of another part, which is read if it has not been.
    fn other(&mut self, path: &str, element: &Element<'_>) -> Result<usize, Located> {
        let name = path.strip_prefix('/').unwrap_or(path);
        if let Some(&part) = self.book.parts.get(name) {
            return Ok(part);
        }
        if !self.is_first {
            return Err(element.unexpected("no reference to a third part", path));
        }
        let part = self.book.parts.len();
        read(self.package, name, false, self.budget, self.book)
            .map_err(|error| error.or_at(element.place()))?;
        Ok(part)
    }

    /// Makes the object that was read.
    fn close(&mut self, xml: &Xml<'_>) -> Result<(), Located> {
        let open = std::mem::take(&mut self.object);
        let mut solids = open.components;
        if open.is_mesh {
            let built = open.faces.build().map_err(|error| Located {
                place: Some(xml.place_at(open.at)),
                kind: ReadErrorKind::Object {
                    name: label(&open.name, open.id),
                    error: Box::new(error.kind),
                },
            })?;
            self.book.turned += usize::from(built.turned);
            let mesh = Solid::mesh(built.mesh);
            self.book.meshes.push(mesh.clone());
            solids.push(mesh);
        }
        let mut solid = union(solids);
        if let Some(color) = open.color {
            solid = solid.colored(color);
        }
        if !open.name.is_empty() {
            solid = solid.named(open.name);
        }
        let object = Object { solid, role: open.role };
        self.book.objects.insert((self.part, open.id), object);
        Ok(())
    }
}

/// How a message names an object.
fn label(name: &str, id: u32) -> Box<str> {
    let name = if name.is_empty() {
        String::new()
    } else {
        format!(" {}", quoted(name.as_bytes()))
    };
    format!("object {id}{name}").into()
}
