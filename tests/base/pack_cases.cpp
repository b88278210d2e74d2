// SPDX-License-Identifier: MIT
#include "base/pack_cases.hpp"

#include "chicane/base/pack.hpp"

namespace chicane::test {

template <class Arch>
void run_pack_cases(const double* a, const double* b, const double* c,
                    double (*result)[kCaseLanes]) noexcept {
  using P = Pack<Arch, kCaseLanes>;
  const P x = P::load_unaligned(a);
  const P y = P::load_unaligned(b);
  const P z = P::load_unaligned(c);
  const auto as_number = [](const Mask<Arch, kCaseLanes>& m) { return select(m, P(1.0), P(0.0)); };
  std::size_t row = 0;
  const auto keep = [&](const P& value) { value.store_unaligned(result[row++]); };
  keep(x + y);
  keep(x - y);
  keep(x * y);
  keep(x / y);
  keep(-x);
  keep(fused_multiply_add(x, y, z));
  keep(fused_negative_multiply_add(x, y, z));
  keep(min(x, y));
  keep(max(x, y));
  keep(abs(x));
  keep(sqrt(abs(x)));
  keep(round(x));
  keep(copysign(x, y));
  keep(as_number(x < y));
  keep(as_number(x <= y));
  keep(as_number(x == y));
  keep(as_number((x < y) & !(y < z)));
  keep(as_number((x < y) | (z > 1.0)));
  keep(as_number(is_finite(x / y)));
  keep(as_number(Mask<Arch, kCaseLanes>::first(3)));
  keep(P::from_bits((bits_of(x) ^ bits_of(y)) >> 12));
  keep(P::from_bits((bits_of(x) << 3) - bits_of(z)));
  keep(P::iota() * sum(x));
  keep(P(largest(x)));
}

template void run_pack_cases<arch::Native>(const double*, const double*, const double*,
                                           double (*)[kCaseLanes]) noexcept;

}  // namespace chicane::test
