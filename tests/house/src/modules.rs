//! Modules of a crate, and the module in which a path's item is defined.

use std::collections::BTreeMap;

use crate::facts::Module;
use crate::tree::Tree;

/// How many imports one is followed through; those that import each other have no end.
const DEEPEST: usize = 16;

/// Modules of a crate, its root first.
#[derive(Default)]
pub(crate) struct Crate<'a>(pub(crate) Vec<Node<'a>>);

/// A module of a crate.
pub(crate) struct Node<'a> {
    /// Its file, with its name if it is within another's.
    pub(crate) name: String,
    /// Its number and those of the modules around it, the crate's root last.
    line: Vec<usize>,
    module: &'a Module,
    children: BTreeMap<&'a str, usize>,
}

/// A module, or an item of one.
#[derive(Clone, Copy)]
enum Target {
    Module(usize),
    ItemOf(usize),
}

impl<'a> Crate<'a> {
    /// The crate with this root, tests apart.
    pub(crate) fn of(tree: &'a Tree, root: &str) -> Self {
        let mut all = Self::default();
        all.add(tree, root, "", &tree.facts[root].module, &[]);
        all
    }

    fn add(&mut self, tree: &'a Tree, file: &str, end: &str, module: &'a Module, above: &[usize]) {
        let (number, name) = (self.0.len(), format!("{file}{end}"));
        let (line, children) = ([&[number], above].concat(), BTreeMap::new());
        self.0.push(Node {
            name,
            line: line.clone(),
            module,
            children,
        });
        for child in module.modules.iter().filter(|child| !child.test) {
            let next = self.0.len();
            if let Some(path) = tree.file_of(file, child) {
                self.add(tree, &path, "", &tree.facts[&path].module, &line);
            } else {
                self.add(tree, file, &format!("{end}::{}", child.name), child, &line);
            }
            self.0[number].children.insert(&child.name, next);
        }
    }

    /// Modules with items that a module uses, each with the line of a use; those around it and within it apart.
    pub(crate) fn used_by(&self, number: usize) -> BTreeMap<usize, usize> {
        let node = &self.0[number];
        let mut used = BTreeMap::new();
        for (path, line) in &node.module.paths {
            let target = self.resolve(number, path, DEEPEST);
            if let Some(Target::Module(other) | Target::ItemOf(other)) = target
                && !node.line.contains(&other)
                && !self.0[other].line.contains(&number)
            {
                used.insert(other, *line);
            }
        }
        used
    }

    fn parent(&self, number: usize) -> usize {
        self.0[number].line.get(1).copied().unwrap_or(number)
    }

    fn resolve(&self, from: usize, path: &[String], depth: usize) -> Option<Target> {
        let (first, rest) = path.split_first()?;
        let start = match first.as_str() {
            "crate" => Target::Module(0),
            "self" => Target::Module(from),
            "super" => Target::Module(self.parent(from)),
            name => self.named(from, name, depth)?,
        };
        let step = |target, name: &String| match target {
            Target::Module(module) if name == "super" => Target::Module(self.parent(module)),
            Target::Module(module) => {
                let found = self.named(module, name, depth);
                found.unwrap_or(Target::ItemOf(module))
            }
            item => item,
        };
        Some(rest.iter().fold(start, step))
    }

    /// What a name in a module stands for; none if that is in another crate or not known.
    fn named(&self, number: usize, name: &str, depth: usize) -> Option<Target> {
        let (depth, node) = (depth.checked_sub(1)?, &self.0[number]);
        if let Some(child) = node.children.get(name) {
            return Some(Target::Module(*child));
        }
        if node.module.items.contains(name) {
            return Some(Target::ItemOf(number));
        }
        let imports = || node.module.imports.iter();
        let is_own = |(known, path): &&(String, Vec<String>)| known == name && path[0] != name;
        if let Some((_, path)) = imports().find(is_own) {
            return self.resolve(number, path, depth);
        }
        let mut globs = imports().filter(|(known, _)| known == "*");
        globs.find_map(|(_, path)| match self.resolve(number, path, depth)? {
            Target::Module(other) if other != number => self.named(other, name, depth),
            _ => None,
        })
    }
}
