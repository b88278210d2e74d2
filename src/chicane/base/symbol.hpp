// SPDX-License-Identifier: MIT
// Symbol: a type without values, by which compilers refuse unsuitable formulas in few lines.
#pragma once

#include <type_traits>

namespace chicane {

// Compilers show the comment behind a deleted function with their message: it says what to write instead.
// clang-format off

/// Result of comparing symbols: selects between values, cannot be branched on.
struct Choice {
  operator bool() const = delete;  // NOLINT  no if, ?:, &&, ||, std::max on variables: write select(x > 1.0, a, b), max(a, b), min or abs; & and | of comparisons
};
Choice operator&(Choice, Choice);
Choice operator|(Choice, Choice);
Choice operator!(Choice);

/// Placeholder for a variable of an optimal control problem. The solver calls the functions of a structured
/// problem with symbols before any other type, so that operations that neither jets nor packs have are refused
/// first. Functions of symbols are declared only, never called.
struct Symbol {
  Symbol();
  Symbol(double constant);         // NOLINT: constants mix freely with symbols, as in formulas
  operator double() const = delete;  // NOLINT  a variable is no number: write sin(x), not std::sin(x); auto y = x, not double y = x
  Symbol& operator+=(Symbol);
  Symbol& operator-=(Symbol);
  Symbol& operator*=(Symbol);
  Symbol& operator/=(Symbol);
  Symbol& operator++() = delete;      // write x + 1.0
  Symbol& operator--() = delete;      // write x - 1.0
};
template <class T>
concept SymbolOrNumber = std::is_same_v<T, Symbol> || std::is_arithmetic_v<T>;
template <class A, class B>
concept WithSymbol = SymbolOrNumber<A> && SymbolOrNumber<B> && (std::is_same_v<A, Symbol> || std::is_same_v<B, Symbol>);

template <class A, class B> requires WithSymbol<A, B> Symbol operator+(A, B);
template <class A, class B> requires WithSymbol<A, B> Symbol operator-(A, B);
template <class A, class B> requires WithSymbol<A, B> Symbol operator*(A, B);
template <class A, class B> requires WithSymbol<A, B> Symbol operator/(A, B);
template <class A, class B> requires WithSymbol<A, B> Choice operator<(A, B);
template <class A, class B> requires WithSymbol<A, B> Choice operator<=(A, B);
template <class A, class B> requires WithSymbol<A, B> Choice operator>(A, B);
template <class A, class B> requires WithSymbol<A, B> Choice operator>=(A, B);
template <class A, class B> requires WithSymbol<A, B> Choice operator==(A, B) = delete;  // variables are hardly ever equal: write abs(a - b) < 1e-9
template <class A, class B> requires WithSymbol<A, B> Symbol operator^(A, B) = delete;   // a power: write pow(x, 2)
template <class A, class B> requires WithSymbol<A, B> Symbol operator%(A, B) = delete;   // has jumps, which no solver gets over: write the formula without
Symbol operator+(Symbol);
Symbol operator-(Symbol);
Choice operator!(Symbol) = delete;  // a variable is no condition: write select(x > 1.0, a, b)

Symbol sin(Symbol);
Symbol cos(Symbol);
Symbol tan(Symbol);
Symbol asin(Symbol);
Symbol acos(Symbol);
Symbol atan(Symbol);
Symbol sqrt(Symbol);
Symbol exp(Symbol);
Symbol log(Symbol);
Symbol tanh(Symbol);
Symbol abs(Symbol);
Symbol positive_part(Symbol);
template <class A, class B> requires WithSymbol<A, B> Symbol atan2(A, B);
template <class A, class B> requires WithSymbol<A, B> Symbol hypot(A, B);
template <class A, class B> requires WithSymbol<A, B> Symbol pow(A, B);
template <class A, class B> requires WithSymbol<A, B> Symbol max(A, B);
template <class A, class B> requires WithSymbol<A, B> Symbol min(A, B);
template <SymbolOrNumber A, SymbolOrNumber B> Symbol select(Choice, A, B);
template <class T> requires std::is_same_v<T, Symbol> Symbol floor(T) = delete;  // has jumps, which no solver gets over: write the formula without
template <class T> requires std::is_same_v<T, Symbol> Symbol round(T) = delete;  // has jumps, which no solver gets over: write the formula without
template <class T> requires std::is_same_v<T, Symbol> Symbol fabs(T) = delete;   // write abs(x)
double value_of(Symbol);

// clang-format on

}  // namespace chicane
