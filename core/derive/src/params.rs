//! `#[stage(...)]` on a parameter struct: serde form, defaults, parameter table, half of the card.

use crate::doc_text;
use proc_macro2::TokenStream;
use quote::quote;
use syn::parse::Parser;
use syn::punctuated::Punctuated;
use syn::{Expr, Fields, Ident, ItemStruct, Lit, LitInt, LitStr, Meta, Token};

/// Fields that every stage has in a pipeline file; the loader takes them for itself.
const GENERIC: [&str; 2] = ["id", "from"];

/// What stands in `#[stage(...)]`.
#[derive(Default)]
struct StageArgs {
    role: Option<Ident>,
    source: Option<LitStr>,
    example: Option<LitStr>,
    version: Option<LitInt>,
    contracts: Vec<Ident>,
}

/// What stands in `#[param(...)]`.
#[derive(Default)]
struct ParamArgs {
    default: Option<Expr>,
    min: Option<Expr>,
    max: Option<Expr>,
    unit: Option<LitStr>,
    trades: bool,
    finer: Option<Ident>,
    way: bool,
    flatten: bool,
}

/// The fields of a struct of parameters.
#[derive(Default)]
struct ParamTable {
    /// The default of each.
    defaults: Vec<TokenStream>,
    /// Their rows, in lists: one of each parameter, all of a group.
    rows: Vec<TokenStream>,
    /// Their names, likewise.
    names: Vec<TokenStream>,
    /// Arms that read those that are no group.
    reads: Vec<TokenStream>,
    writes: Vec<TokenStream>,
    groups: Vec<Ident>,
}

pub(crate) fn expand(attr: TokenStream, mut item: ItemStruct) -> syn::Result<TokenStream> {
    let args = stage_args(attr)?;
    let name = item.ident.clone();
    let name_text = name.to_string();
    let doc = doc_text(&item.attrs);
    if doc.is_empty() {
        return Err(syn::Error::new_spanned(&name, "a stage needs a doc comment: it is its user page"));
    }
    let table = fields(&mut item)?;
    let (default, serde) = (table.default_impl(&name), table.serde(&name));
    let (rows, grouped) = (&table.rows, !table.groups.is_empty());
    let docs = if grouped {
        quote!(::toile_core::param::Params::docs(&default))
    } else {
        quote!(<[::std::vec::Vec<::toile_core::ParamDoc>]>::concat(&[#(#rows),*]))
    };
    let derives = if grouped {
        quote!()
    } else {
        quote! {
            #[derive(::toile_core::serde::Serialize, ::toile_core::serde::Deserialize)]
            #[serde(crate = "::toile_core::serde", deny_unknown_fields, default)]
        }
    };
    let role =
        args.role.ok_or_else(|| syn::Error::new_spanned(&name, "`#[stage(role = ...)]` is missing"))?;
    let source = args.source.map_or_else(String::new, |s| s.value());
    let example = args.example.map_or_else(|| format!("{name_text}()"), |s| s.value());
    let version = args.version.map_or(Ok(1), |v| v.base10_parse::<u32>())?;
    let contracts = &args.contracts;
    Ok(quote! {
        #[derive(Debug, Clone, PartialEq)]
        #derives
        #item

        #default
        #serde

        impl ::toile_core::StageMeta for #name {
            const NAME: &'static str = #name_text;
            fn meta() -> ::toile_core::Card {
                #[allow(unused_variables)]
                let default = <Self as ::std::default::Default>::default();
                ::toile_core::Card {
                    name: #name_text,
                    role: ::toile_core::Role::#role,
                    doc: #doc,
                    source: #source,
                    version: #version,
                    example: #example,
                    contracts: ::std::vec![#(::toile_core::Contract::#contracts),*],
                    params: #docs,
                    inputs: ::std::vec![],
                    outputs: ::std::vec![],
                    package: ::std::concat!(
                        ::std::env!("CARGO_PKG_NAME"), " ", ::std::env!("CARGO_PKG_VERSION")
                    ),
                    plugin: ::std::option::Option::None,
                }
            }
        }
    })
}

/// `#[params]` on a struct: a group.
pub(crate) fn expand_group(mut item: ItemStruct) -> syn::Result<TokenStream> {
    let table = fields(&mut item)?;
    let (default, params) = (table.default_impl(&item.ident), table.params(&item.ident));
    Ok(quote! {
        #[derive(Debug, Clone, PartialEq)]
        #item

        #default
        #params
    })
}

impl ParamTable {
    fn default_impl(&self, name: &Ident) -> TokenStream {
        let defaults = &self.defaults;
        quote! {
            impl ::std::default::Default for #name {
                fn default() -> Self {
                    Self { #(#defaults),* }
                }
            }
        }
    }

    /// The serde form of a stage that has groups; others derive theirs.
    fn serde(&self, name: &Ident) -> TokenStream {
        if self.groups.is_empty() {
            return TokenStream::new();
        }
        let (params, text) = (self.params(name), name.to_string());
        quote! {
            #params

            impl ::toile_core::serde::Serialize for #name {
                fn serialize<S: ::toile_core::serde::Serializer>(
                    &self,
                    s: S,
                ) -> ::std::result::Result<S::Ok, S::Error> {
                    ::toile_core::param::group::write(self, #text, s)
                }
            }

            impl<'de> ::toile_core::serde::Deserialize<'de> for #name {
                fn deserialize<D: ::toile_core::serde::Deserializer<'de>>(
                    d: D,
                ) -> ::std::result::Result<Self, D::Error> {
                    ::toile_core::param::group::read(#text, d)
                }
            }
        }
    }

    fn params(&self, name: &Ident) -> TokenStream {
        let ParamTable { rows, names, reads, writes, groups, .. } = self;
        quote! {
            impl ::toile_core::param::Params for #name {
                const NAMES: &'static [&'static str] = {
                    const PARTS: &[&[&str]] = &[#(#names),*];
                    const ALL: [&str; ::toile_core::param::group::count(PARTS)] =
                        ::toile_core::param::group::joined(PARTS);
                    &ALL
                };
                fn docs(&self) -> ::std::vec::Vec<::toile_core::ParamDoc> {
                    let default = self;
                    <[::std::vec::Vec<::toile_core::ParamDoc>]>::concat(&[#(#rows),*])
                }
                fn read<'de, M: ::toile_core::serde::de::MapAccess<'de>>(
                    &mut self,
                    name: &str,
                    map: &mut M,
                ) -> ::std::result::Result<bool, M::Error> {
                    ::std::result::Result::Ok(match name {
                        #(#reads)*
                        _ => false #(|| ::toile_core::param::Params::read(&mut self.#groups, name, map)?)*,
                    })
                }
                fn write<S: ::toile_core::serde::ser::SerializeStruct>(
                    &self,
                    out: &mut S,
                ) -> ::std::result::Result<(), S::Error> {
                    #(#writes)*
                    ::std::result::Result::Ok(())
                }
            }
        }
    }
}

fn stage_args(attr: TokenStream) -> syn::Result<StageArgs> {
    let mut args = StageArgs::default();
    for meta in Punctuated::<Meta, Token![,]>::parse_terminated.parse2(attr)? {
        match &meta {
            Meta::List(list) if list.path.is_ident("contracts") => {
                let names = Punctuated::<Ident, Token![,]>::parse_terminated.parse2(list.tokens.clone())?;
                args.contracts = names.into_iter().collect();
            }
            Meta::NameValue(nv) if nv.path.is_ident("role") => args.role = Some(expr_ident(&nv.value)?),
            Meta::NameValue(nv) if nv.path.is_ident("source") => args.source = Some(expr_str(&nv.value)?),
            Meta::NameValue(nv) if nv.path.is_ident("example") => args.example = Some(expr_str(&nv.value)?),
            Meta::NameValue(nv) if nv.path.is_ident("version") => args.version = Some(expr_int(&nv.value)?),
            _ => {
                let known = "expected role, source, example, version or contracts(...)";
                return Err(syn::Error::new_spanned(meta, known));
            }
        }
    }
    Ok(args)
}

/// Takes the `#[param]` attributes off the fields.
fn fields(item: &mut ItemStruct) -> syn::Result<ParamTable> {
    let mut table = ParamTable::default();
    let named = match &mut item.fields {
        Fields::Named(named) => &mut named.named,
        Fields::Unit => {
            item.fields = Fields::Named(syn::parse_quote!({}));
            item.semi_token = None;
            return Ok(table);
        }
        Fields::Unnamed(_) => {
            return Err(syn::Error::new_spanned(&item.ident, "a stage's parameters have names"));
        }
    };
    for field in named.iter_mut() {
        let args = param_args(field)?;
        let Some(name) = field.ident.clone() else { continue };
        let (name_text, doc, ty) = (name.to_string(), doc_text(&field.attrs), &field.ty);
        let plain = name_text.trim_start_matches("r#");
        if GENERIC.contains(&plain) {
            let message = format!(
                "every stage has a field `{plain}` of its own in a pipeline file: give the parameter another name"
            );
            return Err(syn::Error::new_spanned(&name, message));
        }
        let value = args.default.map_or(quote!(::std::default::Default::default()), |e| quote!(#e));
        table.defaults.push(quote!(#name: #value));
        if args.flatten {
            table.rows.push(quote!(::toile_core::param::Params::docs(&default.#name)));
            table.names.push(quote!(<#ty as ::toile_core::param::Params>::NAMES));
            table.writes.push(quote!(::toile_core::param::Params::write(&self.#name, out)?;));
            table.groups.push(name);
            continue;
        }
        if doc.is_empty() {
            return Err(syn::Error::new_spanned(&name, "a parameter needs a doc comment"));
        }
        table.names.push(quote!(&[#plain]));
        table.reads.push(quote!(#plain => { self.#name = map.next_value()?; true }));
        table.writes.push(quote!(out.serialize_field(#plain, &self.#name)?;));
        let bound = |e: Option<Expr>| {
            e.map_or(
                quote!(::std::option::Option::None),
                |e| quote!(::std::option::Option::Some((#e) as f64)),
            )
        };
        let (min, max) = (bound(args.min), bound(args.max));
        let (trades, way) = (args.trades, args.way);
        let finer = args.finer.map_or(
            quote!(::std::option::Option::None),
            |way| quote!(::std::option::Option::Some(::toile_core::Finer::#way)),
        );
        let unit = args.unit.map_or_else(String::new, |u| u.value());
        table.rows.push(quote! {
            ::std::vec![::toile_core::ParamDoc {
                name: #name_text,
                doc: #doc,
                kind: <#ty as ::toile_core::ParamType>::describe(),
                unit: #unit,
                min: #min,
                max: #max,
                default: ::toile_core::param::ron_text(&default.#name),
                trades: #trades,
                finer: #finer,
                way: #way,
                check: ::toile_core::param::Check::of::<#ty>(),
            }]
        });
    }
    Ok(table)
}

fn param_args(field: &mut syn::Field) -> syn::Result<ParamArgs> {
    let mut args = ParamArgs::default();
    let (ours, rest): (Vec<_>, Vec<_>) = field.attrs.drain(..).partition(|a| a.path().is_ident("param"));
    field.attrs = rest;
    for attr in ours {
        for meta in attr.parse_args_with(Punctuated::<Meta, Token![,]>::parse_terminated)? {
            match &meta {
                Meta::Path(p) if p.is_ident("trades") => args.trades = true,
                Meta::Path(p) if p.is_ident("way") => args.way = true,
                Meta::Path(p) if p.is_ident("flatten") => args.flatten = true,
                Meta::NameValue(nv) if nv.path.is_ident("default") => args.default = Some(nv.value.clone()),
                Meta::NameValue(nv) if nv.path.is_ident("min") => args.min = Some(nv.value.clone()),
                Meta::NameValue(nv) if nv.path.is_ident("max") => args.max = Some(nv.value.clone()),
                Meta::NameValue(nv) if nv.path.is_ident("unit") => args.unit = Some(expr_str(&nv.value)?),
                Meta::NameValue(nv) if nv.path.is_ident("finer") => args.finer = Some(way(&nv.value)?),
                _ => {
                    let known = "expected default, min, max, unit, trades, finer, way or flatten";
                    return Err(syn::Error::new_spanned(meta, known));
                }
            }
        }
    }
    match (&args.finer, args.trades) {
        (Some(_), false) => {
            let message = "a resolution trades accuracy for time: write `trades` as well";
            Err(syn::Error::new_spanned(&field.ident, message))
        }
        _ => Ok(args),
    }
}

fn expr_ident(e: &Expr) -> syn::Result<Ident> {
    match e {
        Expr::Path(p) => p.path.require_ident().cloned(),
        _ => Err(syn::Error::new_spanned(e, "expected a name")),
    }
}

fn expr_str(e: &Expr) -> syn::Result<LitStr> {
    match e {
        Expr::Lit(syn::ExprLit { lit: Lit::Str(s), .. }) => Ok(s.clone()),
        _ => Err(syn::Error::new_spanned(e, "expected a text in quotes")),
    }
}

/// `"less"` or `"more"` as the variant of `Finer`.
fn way(e: &Expr) -> syn::Result<Ident> {
    let text = expr_str(e)?;
    match text.value().as_str() {
        "less" => Ok(Ident::new("Less", text.span())),
        "more" => Ok(Ident::new("More", text.span())),
        _ => Err(syn::Error::new_spanned(text, "expected \"less\" or \"more\"")),
    }
}

fn expr_int(e: &Expr) -> syn::Result<LitInt> {
    match e {
        Expr::Lit(syn::ExprLit { lit: Lit::Int(i), .. }) => Ok(i.clone()),
        _ => Err(syn::Error::new_spanned(e, "expected a whole number")),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use syn::parse_quote;

    fn refused(param: TokenStream) -> String {
        let item = syn::parse_quote! {
            /// A stage.
            struct A {
                /// A cell.
                #[param(#param)]
                cell: f64,
            }
        };
        expand(quote!(role = Mesher), item).unwrap_err().to_string()
    }

    #[test]
    fn a_resolution_says_which_way_it_is_refined_and_that_it_trades() {
        let (way, trades) = (
            "expected \"less\" or \"more\"",
            "a resolution trades accuracy for time: write `trades` as well",
        );
        assert_eq!(refused(quote!(default = 1.0, trades, finer = "both")), way);
        assert_eq!(refused(quote!(default = 1.0, finer = "less")), trades);
        assert_eq!(
            refused(quote!(coarser = "less")),
            "expected default, min, max, unit, trades, finer, way or flatten"
        );
    }

    fn refused_item(item: ItemStruct) -> String {
        expand(quote!(role = Binariser), item).map_or_else(|e| e.to_string(), |_| "accepted".into())
    }

    #[test]
    fn a_parameter_has_no_name_that_every_stage_has_for_a_field() {
        let with = |name: Ident| -> ItemStruct {
            parse_quote! {
                /// A stage.
                struct Mine {
                    /// A parameter.
                    #[param(default = 1.0)]
                    #name: f64,
                }
            }
        };
        for name in ["from", "id"] {
            let words = format!(
                "every stage has a field `{name}` of its own in a pipeline file: give the parameter another name"
            );
            assert_eq!(refused_item(with(quote::format_ident!("{name}"))), words);
            assert_eq!(refused_item(with(quote::format_ident!("r#{name}"))), words);
        }
        assert_eq!(refused_item(with(quote::format_ident!("from_here"))), "accepted");
    }
}
