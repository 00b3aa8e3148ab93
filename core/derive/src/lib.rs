//! The `stage` and `choice` macros: from one parameter struct and one typed function to the RON
//! form, the checks, the card and the [`Stage`] implementation.
//!
//! `#[stage(role = ..., source = "...", example = "...")]` stands on the parameter struct,
//! `#[stage]` on the `impl` with its `run` function, `#[choice]` on an enum used as a parameter,
//! `#[params]` on parameters that several stages share.

mod choice;
mod params;
mod plugin;
mod run;

use proc_macro::TokenStream;

/// See the crate's page.
#[proc_macro_attribute]
pub fn stage(attr: TokenStream, item: TokenStream) -> TokenStream {
    let expanded = match syn::parse::<syn::Item>(item) {
        Ok(syn::Item::Struct(item)) => params::expand(attr.into(), item),
        Ok(syn::Item::Impl(item)) => run::expand(item),
        Ok(other) => {
            Err(syn::Error::new_spanned(other, "`#[stage]` stands on a parameter struct or on its impl"))
        }
        Err(e) => Err(e),
    };
    expanded.unwrap_or_else(syn::Error::into_compile_error).into()
}

/// Makes a struct a group of parameters, which stages take by `#[param(flatten)]`.
#[proc_macro_attribute]
pub fn params(_attr: TokenStream, item: TokenStream) -> TokenStream {
    syn::parse::<syn::ItemStruct>(item)
        .and_then(params::expand_group)
        .unwrap_or_else(syn::Error::into_compile_error)
        .into()
}

/// Makes an enum usable as a parameter.
#[proc_macro_attribute]
pub fn choice(_attr: TokenStream, item: TokenStream) -> TokenStream {
    syn::parse::<syn::Item>(item)
        .and_then(choice::expand)
        .unwrap_or_else(syn::Error::into_compile_error)
        .into()
}

/// `plugin!(A, B);` at the end of a crate makes its stages a plugin: built as `cdylib` it can be
/// loaded by name, linked in it is added by one line, `my_crate::register(&mut registry)`.
#[proc_macro]
pub fn plugin(stages: TokenStream) -> TokenStream {
    plugin::expand(stages.into()).unwrap_or_else(syn::Error::into_compile_error).into()
}

/// The text of an item's doc comment.
fn doc_text(attrs: &[syn::Attribute]) -> String {
    let line = |a: &syn::Attribute| match &a.meta {
        syn::Meta::NameValue(syn::MetaNameValue {
            path,
            value: syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(s), .. }),
            ..
        }) if path.is_ident("doc") => Some(s.value()),
        _ => None,
    };
    let lines: Vec<String> =
        attrs.iter().filter_map(line).map(|l| l.strip_prefix(' ').unwrap_or(&l).to_owned()).collect();
    lines.join("\n").trim().to_owned()
}
