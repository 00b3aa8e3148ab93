//! `#[stage]` on an `impl`: ports and the `Stage` implementation from the typed `run` function.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::{FnArg, GenericArgument, ImplItem, ImplItemFn, ItemImpl, Pat, PathArguments, ReturnType, Type};

/// One artifact argument of `run`.
struct ArgumentPort {
    name: String,
    ty: Type,
    original: bool,
    sewn: bool,
}

pub(crate) fn expand(mut item: ItemImpl) -> syn::Result<TokenStream> {
    let ty = item.self_ty.clone();
    let missing = syn::Error::new_spanned(
        &ty,
        "a stage needs `fn run(&self, ..., cx: &Context) -> Result<..., StageError>`",
    );
    let run = item
        .items
        .iter_mut()
        .find_map(|i| match i {
            ImplItem::Fn(f) if f.sig.ident == "run" => Some(f),
            _ => None,
        })
        .ok_or(missing)?;
    let ports = ports(run)?;
    let out = output(run)?;
    renamed(&item)?;
    let hooks = hooks(&item);
    let in_ports = ports.iter().map(|ArgumentPort { name, ty, original, sewn }| {
        quote! {{
            let (kind, arity, optional) = <#ty as ::toile_core::Input>::port();
            ::toile_core::InPort { name: #name, kind, arity, optional, original: #original, sewn: #sewn }
        }}
    });
    let takes = ports.iter().enumerate().map(|(i, ArgumentPort { name, ty, .. })| {
        quote! {
            <#ty as ::toile_core::Input>::take(inputs.0.get(#i).and_then(::std::option::Option::as_ref))
                .ok_or_else(|| ::toile_core::StageError::internal(concat!("port `", #name, "` got another type")))?
        }
    });
    Ok(quote! {
        #item

        const _: () = {
            ::toile_core::stage_impl! { impl ::toile_core::Stage for #ty {
                fn card(&self) -> ::toile_core::Card {
                    <Self as ::toile_core::StageType>::type_card()
                }
                fn params(&self) -> ::std::string::String {
                    ::toile_core::param::ron_text(self)
                }
                #(#hooks)*
                fn run_ports(
                    &self,
                    inputs: &::toile_core::Inputs,
                    cx: &::toile_core::Context,
                ) -> ::std::result::Result<::std::vec::Vec<::toile_core::PortValue>, ::toile_core::StageError> {
                    let out = Self::run(self, #(#takes,)* cx)?;
                    ::std::result::Result::Ok(::toile_core::Output::pack(out))
                }
            } }

            impl ::toile_core::StageType for #ty {
                fn type_card() -> ::toile_core::Card {
                    ::toile_core::Card {
                        inputs: ::std::vec![#(#in_ports),*],
                        outputs: <#out as ::toile_core::Output>::ports(),
                        ..<Self as ::toile_core::StageMeta>::meta()
                    }
                }
            }
        };
    })
}

/// The functions beside `run` that the author may write; the trait has each under the same name.
fn hooks(item: &ItemImpl) -> Vec<TokenStream> {
    let placed = || vec![("placed", quote!(&::toile_core::Placed<'_>))];
    let errors = || quote!(::std::vec::Vec<::toile_core::StageError>);
    let size = quote!(::toile_core::cost::Size);
    let given = vec![("given", quote!(&#size)), ("cx", quote!(&::toile_core::Context))];
    let known = vec![("known", quote!(&::toile_core::Known<'_>))];
    let nodes = vec![("nodes", quote!(&[::toile_core::Node])), ("index", quote!(usize))];
    [
        ("sizes", given, quote!(::std::option::Option<#size>)),
        ("decisions", known, quote!(::std::vec::Vec<::toile_core::decide::Decision>)),
        ("by_place", nodes, quote!(::toile_core::ByPlace)),
        ("asks", vec![], quote!(::std::vec::Vec<(&'static str, ::std::string::String)>)),
        ("faults", placed(), errors()),
        ("warnings", placed(), errors()),
        ("improves", vec![], quote!(bool)),
    ]
    .into_iter()
    .filter(|(name, ..)| has(item, name))
    .map(|(name, takes, gives)| {
        let name = format_ident!("{name}");
        let (names, types): (Vec<_>, Vec<_>) =
            takes.into_iter().map(|(n, t)| (format_ident!("{n}"), t)).unzip();
        quote! { fn #name(&self, #(#names: #types),*) -> #gives { Self::#name(self, #(#names),*) } }
    })
    .collect()
}

/// Names that such functions had before: without this an old function would never be called.
const RENAMED: [(&str, &str); 3] = [("precheck", "faults"), ("foresee", "sizes"), ("decide", "decisions")];

fn renamed(item: &ItemImpl) -> syn::Result<()> {
    match RENAMED.iter().find(|(old, _)| has(item, old)) {
        Some((old, new)) => Err(syn::Error::new_spanned(
            &item.self_ty,
            format!("`fn {old}` of a stage is called `fn {new}` now"),
        )),
        None => Ok(()),
    }
}

/// Whether the author wrote a function of that name.
fn has(item: &ItemImpl, name: &str) -> bool {
    item.items.iter().any(|i| matches!(i, ImplItem::Fn(f) if f.sig.ident == name))
}

/// The arguments between `&self` and the context; `#[original]` and `#[sewn]` are read and taken
/// off.
fn ports(run: &mut ImplItemFn) -> syn::Result<Vec<ArgumentPort>> {
    let count = run.sig.inputs.len();
    let mut ports = Vec::new();
    for (i, arg) in run.sig.inputs.iter_mut().enumerate() {
        let FnArg::Typed(arg) = arg else { continue };
        if i + 1 == count {
            continue;
        }
        let mut take = |name: &str| {
            let before = arg.attrs.len();
            arg.attrs.retain(|a| !a.path().is_ident(name));
            arg.attrs.len() != before
        };
        let (original, sewn) = (take("original"), take("sewn"));
        let Pat::Ident(name) = arg.pat.as_ref() else {
            return Err(syn::Error::new_spanned(&arg.pat, "a port needs a name"));
        };
        ports.push(ArgumentPort {
            name: name.ident.to_string().trim_start_matches('_').to_owned(),
            ty: (*arg.ty).clone(),
            original,
            sewn,
        });
    }
    Ok(ports)
}

/// The `T` of `-> Result<T, StageError>`.
fn output(run: &ImplItemFn) -> syn::Result<Type> {
    let wrong = || syn::Error::new_spanned(&run.sig, "`run` returns `Result<..., StageError>`");
    let ReturnType::Type(_, ty) = &run.sig.output else { return Err(wrong()) };
    let Type::Path(path) = ty.as_ref() else { return Err(wrong()) };
    let PathArguments::AngleBracketed(args) = &path.path.segments.last().ok_or_else(wrong)?.arguments else {
        return Err(wrong());
    };
    match args.args.first() {
        Some(GenericArgument::Type(t)) => Ok(t.clone()),
        _ => Err(wrong()),
    }
}
