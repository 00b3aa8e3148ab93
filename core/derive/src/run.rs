//! `#[stage]` on an `impl`: ports and the `Stage` implementation from the typed `run` function.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{FnArg, GenericArgument, ImplItem, ImplItemFn, ItemImpl, Pat, PathArguments, ReturnType, Type};

/// One artifact argument of `run`.
struct Port {
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
    let (sizes, decisions, faults) = (sizes(&item), decisions(&item), faults(&item));
    let (warnings, improves) = (warnings(&item), improves(&item));
    let by_place = by_place(&item);
    let in_ports = ports.iter().map(|Port { name, ty, original, sewn }| {
        quote! {{
            let (kind, arity, optional) = <#ty as ::toile_core::Input>::port();
            ::toile_core::InPort { name: #name, kind, arity, optional, original: #original, sewn: #sewn }
        }}
    });
    let takes = ports.iter().enumerate().map(|(i, Port { name, ty, .. })| {
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
                #sizes
                #decisions
                #by_place
                #faults
                #warnings
                #improves
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

/// The trait's `sizes`, where the author says by `foresee` how sizes go through the stage.
fn sizes(item: &ItemImpl) -> TokenStream {
    match has(item, "foresee") {
        false => TokenStream::new(),
        true => quote! {
            fn sizes(
                &self,
                given: &::toile_core::cost::Size,
                cx: &::toile_core::Context,
            ) -> ::std::option::Option<::toile_core::cost::Size> {
                Self::foresee(self, given, cx)
            }
        },
    }
}

/// The trait's `decisions`, where the author tells them by `decide`.
fn decisions(item: &ItemImpl) -> TokenStream {
    match has(item, "decide") {
        false => TokenStream::new(),
        true => quote! {
            fn decisions(
                &self,
                known: &::toile_core::Known<'_>,
            ) -> ::std::vec::Vec<::toile_core::decide::Decision> {
                Self::decide(self, known)
            }
        },
    }
}

/// The trait's `by_place`, where the author gives parameters by a function of that name.
fn by_place(item: &ItemImpl) -> TokenStream {
    match has(item, "by_place") {
        false => TokenStream::new(),
        true => quote! {
            fn by_place(
                &self,
                nodes: &[::toile_core::Node],
                index: usize,
            ) -> ::toile_core::ByPlace {
                Self::by_place(self, nodes, index)
            }
        },
    }
}

/// The trait's `faults`, where the author looks at parameters and files by `precheck`.
fn faults(item: &ItemImpl) -> TokenStream {
    match has(item, "precheck") {
        false => TokenStream::new(),
        true => quote! {
            fn faults(
                &self,
                placed: &::toile_core::Placed<'_>,
            ) -> ::std::vec::Vec<::toile_core::StageError> {
                Self::precheck(self, placed)
            }
        },
    }
}

/// The trait's `warnings`, where the author gives some by a function of that name.
fn warnings(item: &ItemImpl) -> TokenStream {
    match has(item, "warnings") {
        false => TokenStream::new(),
        true => quote! {
            fn warnings(
                &self,
                placed: &::toile_core::Placed<'_>,
            ) -> ::std::vec::Vec<::toile_core::StageError> {
                Self::warnings(self, placed)
            }
        },
    }
}

/// The trait's `improves`, where the author says by a function of that name with which parameters
/// it does.
fn improves(item: &ItemImpl) -> TokenStream {
    match has(item, "improves") {
        false => TokenStream::new(),
        true => quote! {
            fn improves(&self) -> bool {
                Self::improves(self)
            }
        },
    }
}

/// Whether the author wrote a function of that name.
fn has(item: &ItemImpl, name: &str) -> bool {
    item.items.iter().any(|i| matches!(i, ImplItem::Fn(f) if f.sig.ident == name))
}

/// The arguments between `&self` and the context; `#[original]` and `#[sewn]` are read and taken
/// off.
fn ports(run: &mut ImplItemFn) -> syn::Result<Vec<Port>> {
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
        ports.push(Port {
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
