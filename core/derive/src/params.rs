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
}

pub(crate) fn expand(attr: TokenStream, mut item: ItemStruct) -> syn::Result<TokenStream> {
    let args = stage_args(attr)?;
    let name = item.ident.clone();
    let name_text = name.to_string();
    let doc = doc_text(&item.attrs);
    if doc.is_empty() {
        return Err(syn::Error::new_spanned(&name, "a stage needs a doc comment: it is its user page"));
    }
    let (defaults, docs) = fields(&mut item)?;
    let role =
        args.role.ok_or_else(|| syn::Error::new_spanned(&name, "`#[stage(role = ...)]` is missing"))?;
    let source = args.source.map_or_else(String::new, |s| s.value());
    let example = args.example.map_or_else(|| format!("{name_text}()"), |s| s.value());
    let version = args.version.map_or(Ok(1), |v| v.base10_parse::<u32>())?;
    let contracts = &args.contracts;
    Ok(quote! {
        #[derive(Debug, Clone, PartialEq, ::toile_core::serde::Serialize, ::toile_core::serde::Deserialize)]
        #[serde(crate = "::toile_core::serde", deny_unknown_fields, default)]
        #item

        impl ::std::default::Default for #name {
            fn default() -> Self {
                Self { #(#defaults),* }
            }
        }

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
                    params: ::std::vec![#(#docs),*],
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

/// Takes the `#[param]` attributes off the fields; returns the default of each and its table row.
fn fields(item: &mut ItemStruct) -> syn::Result<(Vec<TokenStream>, Vec<TokenStream>)> {
    let (mut defaults, mut docs) = (Vec::new(), Vec::new());
    let named = match &mut item.fields {
        Fields::Named(named) => &mut named.named,
        Fields::Unit => {
            item.fields = Fields::Named(syn::parse_quote!({}));
            item.semi_token = None;
            return Ok((defaults, docs));
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
        if doc.is_empty() {
            return Err(syn::Error::new_spanned(&name, "a parameter needs a doc comment"));
        }
        let value = args.default.map_or(quote!(::std::default::Default::default()), |e| quote!(#e));
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
        defaults.push(quote!(#name: #value));
        docs.push(quote! {
            ::toile_core::ParamDoc {
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
            }
        });
    }
    Ok((defaults, docs))
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
                Meta::NameValue(nv) if nv.path.is_ident("default") => args.default = Some(nv.value.clone()),
                Meta::NameValue(nv) if nv.path.is_ident("min") => args.min = Some(nv.value.clone()),
                Meta::NameValue(nv) if nv.path.is_ident("max") => args.max = Some(nv.value.clone()),
                Meta::NameValue(nv) if nv.path.is_ident("unit") => args.unit = Some(expr_str(&nv.value)?),
                Meta::NameValue(nv) if nv.path.is_ident("finer") => args.finer = Some(way(&nv.value)?),
                _ => {
                    let known = "expected default, min, max, unit, trades, finer or way";
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
            "expected default, min, max, unit, trades, finer or way"
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
