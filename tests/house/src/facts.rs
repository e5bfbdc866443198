//! What the rules need to know of one Rust file, found in a single walk over its syntax.
//!
//! A macro's arguments are walked if they are expressions or items, as those of `assert!` and `wire_struct!` are.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::TokenStream;
use syn::parse::Parser;
use syn::punctuated::Punctuated;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{Attribute, Expr, Item, Lit, Meta, Type, UseTree};

/// Paths, each with the line of its first occurrence.
pub(crate) type Paths = BTreeMap<Vec<String>, usize>;

/// Facts of a Rust file. But for sizes and assertions they are those of what is compiled without `cfg(test)`.
#[derive(Default)]
pub(crate) struct Facts {
    /// Functions, sized by their lines; those whose body is one table are left out.
    pub(crate) functions: Vec<Measured>,
    /// Structs, sized by their fields.
    pub(crate) structs: Vec<Measured>,
    /// String literals that an assertion looks for in a text, with their lines.
    pub(crate) asserted: Vec<(String, usize)>,
    /// Lines of items under `cfg(test)`.
    pub(crate) test_lines: usize,
    /// String literals, but for documentation, with their lines.
    pub(crate) texts: Vec<(String, usize)>,
    /// String literals that another text is compared with.
    pub(crate) sought: Vec<Sought>,
    /// Types with an inherent `impl`.
    pub(crate) impls: BTreeSet<String>,
    /// Lines of the types `Result<_, String>`.
    pub(crate) text_errors: Vec<usize>,
    /// The file's module, with those that are written within it.
    pub(crate) module: Module,
}

/// A named item with a size.
pub(crate) struct Measured {
    pub(crate) name: String,
    pub(crate) line: usize,
    pub(crate) size: usize,
}

/// Whether a message has a text.
type Finds = fn(&str, &str) -> bool;

/// A literal that another text is compared with.
pub(crate) struct Sought {
    pub(crate) text: String,
    pub(crate) line: usize,
    /// Whether the comparison finds it in a message.
    pub(crate) finds: Finds,
}

/// A module, as its file says.
#[derive(Default)]
pub(crate) struct Module {
    /// Its name; empty for that of the file.
    pub(crate) name: String,
    /// Whether it is compiled only with `cfg(test)`.
    pub(crate) test: bool,
    /// Whether another file has its content.
    pub(crate) elsewhere: bool,
    /// Modules within it.
    pub(crate) modules: Vec<Module>,
    /// Names of its other items.
    pub(crate) items: BTreeSet<String>,
    /// Its imports: name and path; those of all names of a module are called `*`.
    pub(crate) imports: Vec<(String, Vec<String>)>,
    /// Paths of at least two segments in its code, imports included.
    pub(crate) paths: Paths,
}

impl Facts {
    /// Facts of a file's text.
    pub(crate) fn of(text: &str) -> syn::Result<Self> {
        let mut walk = Walk::default();
        walk.modules.push(Module::default());
        walk.visit_file(&syn::parse_file(text)?);
        walk.facts.module = walk.modules.swap_remove(0);
        Ok(walk.facts)
    }

    /// Paths in the file, tests apart.
    pub(crate) fn paths(&self) -> Paths {
        let (mut paths, mut open) = (Paths::new(), vec![&self.module]);
        while let Some(module) = open.pop() {
            paths.extend(module.paths.clone());
            open.extend(module.modules.iter().filter(|child| !child.test));
        }
        paths
    }
}

/// Whether attributes have `cfg(test)`.
fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| match &attribute.meta {
        Meta::List(list) => list.path.is_ident("cfg") && list.tokens.to_string() == "test",
        _ => false,
    })
}

/// Name that an item brings into its module, and its attributes.
fn describe(item: &Item) -> (Option<&syn::Ident>, &[Attribute]) {
    match item {
        Item::Const(item) => (Some(&item.ident), &item.attrs),
        Item::Enum(item) => (Some(&item.ident), &item.attrs),
        Item::Fn(item) => (Some(&item.sig.ident), &item.attrs),
        Item::Static(item) => (Some(&item.ident), &item.attrs),
        Item::Struct(item) => (Some(&item.ident), &item.attrs),
        Item::Trait(item) => (Some(&item.ident), &item.attrs),
        Item::Type(item) => (Some(&item.ident), &item.attrs),
        Item::Macro(item) => (item.ident.as_ref(), &item.attrs),
        Item::Impl(item) => (None, &item.attrs),
        Item::Mod(item) => (None, &item.attrs),
        _ => (None, &[]),
    }
}

/// Whether an expression is a table: literals, names, and what puts them together without computing anything.
fn is_table(expr: &Expr) -> bool {
    match expr {
        Expr::Lit(_) | Expr::Path(_) => true,
        Expr::Array(array) => array.elems.iter().all(is_table),
        Expr::Tuple(tuple) => tuple.elems.iter().all(is_table),
        Expr::Reference(reference) => is_table(&reference.expr),
        Expr::Unary(unary) => is_table(&unary.expr),
        Expr::Struct(item) => item.fields.iter().all(|field| is_table(&field.expr)),
        Expr::Call(call) => is_table(&call.func) && call.args.iter().all(is_table),
        Expr::Match(table) => table.arms.iter().all(|arm| is_table(&arm.body)),
        _ => false,
    }
}

fn name_of(ty: &Type) -> Option<String> {
    let Type::Path(path) = ty else { return None };
    Some(path.path.segments.last()?.ident.to_string())
}

fn line_of(item: &impl Spanned) -> usize {
    item.span().start().line
}

/// Whether a text is a message with a place in braces, which stands for less than the other words.
fn is_one(message: &str, text: &str) -> bool {
    let (start, rest) = message.split_once('{').unwrap_or_default();
    let (inner, end) = rest.rsplit_once('}').unwrap_or_default();
    let fits = text.starts_with(start) && text.ends_with(end) && !inner.contains('{');
    fits && text.len() < 2 * (start.len() + end.len())
}

/// The walk over a file.
#[derive(Default)]
struct Walk {
    facts: Facts,
    /// The module that the walk is in, after those around it.
    modules: Vec<Module>,
    /// Names of the types and functions around the walk.
    scope: Vec<String>,
    /// Constants of the file that are texts.
    constants: BTreeMap<String, String>,
    in_test: bool,
    in_assertion: bool,
}

impl Walk {
    /// The module, unless only a part of it that is for tests is walked.
    fn module(&mut self) -> Option<&mut Module> {
        let module = self.modules.last_mut()?;
        (module.test == self.in_test).then_some(module)
    }

    fn within(&mut self, name: String, walk: impl FnOnce(&mut Self)) {
        self.scope.push(name);
        walk(self);
        self.scope.pop();
    }

    fn path(&mut self, segments: Vec<String>, line: usize) {
        if let Some(module) = self.module().filter(|_| segments.len() > 1) {
            module.paths.entry(segments).or_insert(line);
        }
    }

    fn import(&mut self, tree: &UseTree, before: &[String]) {
        let (name, last) = match tree {
            UseTree::Path(path) => {
                let before = [before, &[path.ident.to_string()]].concat();
                return self.import(&path.tree, &before);
            }
            UseTree::Group(group) => {
                for tree in &group.items {
                    self.import(tree, before);
                }
                return;
            }
            UseTree::Glob(_) => ("*".to_owned(), None),
            UseTree::Name(name) if name.ident == "self" => {
                (before.last().cloned().unwrap_or_default(), None)
            }
            UseTree::Name(name) => (name.ident.to_string(), Some(&name.ident)),
            UseTree::Rename(name) => (name.rename.to_string(), Some(&name.ident)),
        };
        let mut path = before.to_vec();
        path.extend(last.map(ToString::to_string).filter(|last| last != "self"));
        if let Some(module) = self.module() {
            module.imports.push((name, path.clone()));
        }
        self.path(path, line_of(tree));
    }

    /// The texts of an expression: a literal or a constant, or several in an array.
    fn texts(&self, expr: &Expr) -> Vec<String> {
        match expr {
            Expr::Array(array) => {
                let elements = array.elems.iter();
                elements.flat_map(|element| self.texts(element)).collect()
            }
            Expr::Reference(reference) => self.texts(&reference.expr),
            Expr::Path(path) => {
                let name = path.path.get_ident().map(ToString::to_string);
                let text = name.and_then(|name| self.constants.get(&name));
                Vec::from_iter(text.cloned())
            }
            Expr::Lit(lit) => match &lit.lit {
                Lit::Str(text) => vec![text.value()],
                _ => Vec::new(),
            },
            _ => Vec::new(),
        }
    }

    fn sought(&mut self, expr: &Expr, asserted: bool, finds: Finds) {
        let line = line_of(expr);
        for text in self.texts(expr) {
            if asserted {
                self.facts.asserted.push((text.clone(), line));
            }
            if !self.in_test {
                self.facts.sought.push(Sought { text, line, finds });
            }
        }
    }

    fn function(&mut self, sig: &syn::Signature, block: &syn::Block) {
        if !matches!(&block.stmts[..], [syn::Stmt::Expr(expr, None)] if is_table(expr)) {
            let line = line_of(&sig.fn_token);
            let size = 1 + block.brace_token.span.close().end().line - line;
            let name = self.scope.join("::");
            self.facts.functions.push(Measured { name, line, size });
        }
    }

    fn tokens(&mut self, tokens: &TokenStream) {
        let values = Punctuated::<Expr, syn::Token![,]>::parse_terminated.parse2(tokens.clone());
        if let Ok(values) = values {
            values.iter().for_each(|value| self.visit_expr(value));
        } else if let Ok(file) = syn::parse2::<syn::File>(tokens.clone()) {
            file.items.iter().for_each(|item| self.visit_item(item));
        }
    }
}

impl<'ast> Visit<'ast> for Walk {
    fn visit_item(&mut self, item: &'ast Item) {
        let (name, attributes) = describe(item);
        let outermost = is_test(attributes) && !self.in_test;
        if outermost {
            self.facts.test_lines += 1 + item.span().end().line - line_of(item);
        }
        self.in_test |= outermost;
        if let (Some(name), Some(module)) = (name, self.module()) {
            module.items.insert(name.to_string());
        }
        visit::visit_item(self, item);
        self.in_test &= !outermost;
    }

    fn visit_item_mod(&mut self, item: &'ast syn::ItemMod) {
        self.modules.push(Module {
            name: item.ident.to_string(),
            test: self.in_test,
            elsewhere: item.content.is_none(),
            ..Module::default()
        });
        visit::visit_item_mod(self, item);
        if let (Some(module), Some(parent)) = (self.modules.pop(), self.modules.last_mut()) {
            parent.modules.push(module);
        }
    }

    fn visit_item_const(&mut self, item: &'ast syn::ItemConst) {
        if let Some(text) = self.texts(&item.expr).pop() {
            self.constants.insert(item.ident.to_string(), text);
        }
        visit::visit_item_const(self, item);
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        self.import(&item.tree, &[]);
    }

    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        self.within(item.sig.ident.to_string(), |walk| {
            walk.function(&item.sig, &item.block);
            visit::visit_item_fn(walk, item);
        });
    }

    fn visit_impl_item_fn(&mut self, item: &'ast syn::ImplItemFn) {
        self.within(item.sig.ident.to_string(), |walk| {
            walk.function(&item.sig, &item.block);
            visit::visit_impl_item_fn(walk, item);
        });
    }

    fn visit_item_impl(&mut self, item: &'ast syn::ItemImpl) {
        let name = name_of(&item.self_ty).unwrap_or_default();
        if item.trait_.is_none() && !self.in_test {
            self.facts.impls.insert(name.clone());
        }
        self.within(name, |walk| visit::visit_item_impl(walk, item));
    }

    fn visit_item_struct(&mut self, item: &'ast syn::ItemStruct) {
        let (name, line) = (item.ident.to_string(), line_of(&item.ident));
        let size = item.fields.len();
        self.facts.structs.push(Measured { name, line, size });
        visit::visit_item_struct(self, item);
    }

    fn visit_type_path(&mut self, ty: &'ast syn::TypePath) {
        if let Some(last) = ty.path.segments.last()
            && let syn::PathArguments::AngleBracketed(list) = &last.arguments
            && last.ident == "Result"
            && let Some(syn::GenericArgument::Type(error)) = list.args.get(1)
            && name_of(error).as_deref() == Some("String")
            && !self.in_test
        {
            self.facts.text_errors.push(line_of(ty));
        }
        visit::visit_type_path(self, ty);
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let names = path.segments.iter().map(|name| name.ident.to_string());
        self.path(names.collect(), line_of(&path.segments[0].ident));
        visit::visit_path(self, path);
    }

    fn visit_lit_str(&mut self, text: &'ast syn::LitStr) {
        if !self.in_test {
            let line = text.span().start().line;
            self.facts.texts.push((text.value(), line));
        }
    }

    fn visit_attribute(&mut self, attribute: &'ast Attribute) {
        if let Meta::List(list) = &attribute.meta {
            self.tokens(&list.tokens);
        }
    }

    fn visit_macro(&mut self, call: &'ast syn::Macro) {
        let before = self.in_assertion;
        let name = call.path.segments.last().map(|name| name.ident.to_string());
        self.in_assertion |= name.is_some_and(|name| name.contains("assert"));
        self.visit_path(&call.path);
        self.tokens(&call.tokens);
        self.in_assertion = before;
    }

    fn visit_expr_method_call(&mut self, call: &'ast syn::ExprMethodCall) {
        let finds: Option<Finds> = match call.method.to_string().as_str() {
            "strip_prefix" | "starts_with" => Some(|message, text| message.starts_with(text)),
            "strip_suffix" | "ends_with" => Some(|message, text| message.ends_with(text)),
            "contains" | "find" | "matches" | "split" | "split_once" | "rsplit_once" => {
                Some(|message, text| message.contains(text))
            }
            _ => None,
        };
        for (argument, finds) in call.args.iter().zip(finds) {
            self.sought(argument, self.in_assertion, finds);
        }
        visit::visit_expr_method_call(self, call);
    }

    fn visit_expr_binary(&mut self, binary: &'ast syn::ExprBinary) {
        if matches!(binary.op, syn::BinOp::Eq(_) | syn::BinOp::Ne(_)) {
            self.sought(&binary.right, false, is_one);
        }
        visit::visit_expr_binary(self, binary);
    }
}
