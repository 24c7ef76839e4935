/// The members of an aggregate, one after the other, in the order in which they stand: a struct whose members are the
/// fields of a message need not list them once more.
///
/// C++20 has no words for it. How many there are is found by trying; the rest are structured bindings.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

namespace skyloop::inline receiver {

namespace members {

/// Stands for a member of any type; is never made.
struct Any {
    template <class T>
    operator T() const;  // NOLINT: converts on purpose
};

template <class T, std::size_t... I>
concept TakesAll = requires {
    T{(static_cast<void>(I), Any{})...};
};

template <class T, std::size_t... I>
consteval std::size_t count(std::index_sequence<I...>) {
    if constexpr (TakesAll<T, I..., sizeof...(I)>)
        return count<T>(std::make_index_sequence<sizeof...(I) + 1>{});
    else
        return sizeof...(I);
}

}  // namespace members

/// How many members an aggregate has.
template <class T>
inline constexpr std::size_t member_count = members::count<T>(std::index_sequence<>{});

// clang-format off
namespace members {

template <class M, class V>
decltype(auto) bind_most(M& all, V&& to) {
    constexpr std::size_t size = member_count<std::remove_const_t<M>>;
    static_assert(size <= 35, "add a row for so many members");
    if constexpr (size == 26) { auto& [a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w,x,y,z,A] = all;
        return to(a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w,x,y,z,A); }
    if constexpr (size == 27) { auto& [a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w,x,y,z,A,B] = all;
        return to(a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w,x,y,z,A,B); }
    if constexpr (size == 28) { auto& [a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w,x,y,z,A,B,C] = all;
        return to(a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w,x,y,z,A,B,C); }
    if constexpr (size == 29) { auto& [a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w,x,y,z,A,B,C,D] = all;
        return to(a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w,x,y,z,A,B,C,D); }
    if constexpr (size == 30) { auto& [a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w,x,y,z,A,B,C,D,E] = all;
        return to(a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w,x,y,z,A,B,C,D,E); }
    if constexpr (size == 31) { auto& [a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w,x,y,z,A,B,C,D,E,F] = all;
        return to(a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w,x,y,z,A,B,C,D,E,F); }
    if constexpr (size == 32) { auto& [a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w,x,y,z,A,B,C,D,E,F,G] = all;
        return to(a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w,x,y,z,A,B,C,D,E,F,G); }
    if constexpr (size == 33) { auto& [a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w,x,y,z,A,B,C,D,E,F,G,H] = all;
        return to(a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w,x,y,z,A,B,C,D,E,F,G,H); }
    if constexpr (size == 34) { auto& [a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w,x,y,z,A,B,C,D,E,F,G,H,I] = all;
        return to(a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w,x,y,z,A,B,C,D,E,F,G,H,I); }
    if constexpr (size == 35) { auto& [a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w,x,y,z,A,B,C,D,E,F,G,H,I,J] = all;
        return to(a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w,x,y,z,A,B,C,D,E,F,G,H,I,J); }
}

template <class M, class V>
decltype(auto) bind_many(M& all, V&& to) {
    constexpr std::size_t size = member_count<std::remove_const_t<M>>;
    if constexpr (size == 16) { auto& [a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p] = all;
        return to(a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p); }
    if constexpr (size == 17) { auto& [a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q] = all;
        return to(a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q); }
    if constexpr (size == 18) { auto& [a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r] = all;
        return to(a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r); }
    if constexpr (size == 19) { auto& [a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s] = all;
        return to(a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s); }
    if constexpr (size == 20) { auto& [a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t] = all;
        return to(a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t); }
    if constexpr (size == 21) { auto& [a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u] = all;
        return to(a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u); }
    if constexpr (size == 22) { auto& [a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w] = all;
        return to(a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w); }
    if constexpr (size == 23) { auto& [a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w,x] = all;
        return to(a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w,x); }
    if constexpr (size == 24) { auto& [a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w,x,y] = all;
        return to(a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w,x,y); }
    if constexpr (size == 25) { auto& [a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w,x,y,z] = all;
        return to(a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,w,x,y,z); }
    if constexpr (size > 25) return bind_most(all, std::forward<V>(to));
}

}  // namespace members

/// to(first, second, …) with all members, of which there are at most 35.
template <class M, class V>
decltype(auto) with_members(M& all, V&& to) {
    constexpr std::size_t size = member_count<std::remove_const_t<M>>;
    if constexpr (size == 1) { auto& [a] = all; return to(a); }
    if constexpr (size == 2) { auto& [a,b] = all; return to(a,b); }
    if constexpr (size == 3) { auto& [a,b,c] = all; return to(a,b,c); }
    if constexpr (size == 4) { auto& [a,b,c,d] = all; return to(a,b,c,d); }
    if constexpr (size == 5) { auto& [a,b,c,d,e] = all; return to(a,b,c,d,e); }
    if constexpr (size == 6) { auto& [a,b,c,d,e,f] = all; return to(a,b,c,d,e,f); }
    if constexpr (size == 7) { auto& [a,b,c,d,e,f,g] = all; return to(a,b,c,d,e,f,g); }
    if constexpr (size == 8) { auto& [a,b,c,d,e,f,g,h] = all; return to(a,b,c,d,e,f,g,h); }
    if constexpr (size == 9) { auto& [a,b,c,d,e,f,g,h,i] = all; return to(a,b,c,d,e,f,g,h,i); }
    if constexpr (size == 10) { auto& [a,b,c,d,e,f,g,h,i,j] = all; return to(a,b,c,d,e,f,g,h,i,j); }
    if constexpr (size == 11) { auto& [a,b,c,d,e,f,g,h,i,j,k] = all; return to(a,b,c,d,e,f,g,h,i,j,k); }
    if constexpr (size == 12) { auto& [a,b,c,d,e,f,g,h,i,j,k,l] = all; return to(a,b,c,d,e,f,g,h,i,j,k,l); }
    if constexpr (size == 13) { auto& [a,b,c,d,e,f,g,h,i,j,k,l,m] = all; return to(a,b,c,d,e,f,g,h,i,j,k,l,m); }
    if constexpr (size == 14) { auto& [a,b,c,d,e,f,g,h,i,j,k,l,m,n] = all; return to(a,b,c,d,e,f,g,h,i,j,k,l,m,n); }
    if constexpr (size == 15) { auto& [a,b,c,d,e,f,g,h,i,j,k,l,m,n,o] = all; return to(a,b,c,d,e,f,g,h,i,j,k,l,m,n,o); }
    if constexpr (size > 15) return members::bind_many(all, std::forward<V>(to));
}
// clang-format on

}  // namespace skyloop::inline receiver
