// SPDX-License-Identifier: MIT
#include "chicane/base/owned.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

namespace chicane {
namespace {

struct Shape {
  virtual ~Shape() = default;
  [[nodiscard]] virtual double area() const = 0;
  [[nodiscard]] virtual std::unique_ptr<Shape> copy() const = 0;
};
std::unique_ptr<Shape> copy_of(const Shape& shape) { return shape.copy(); }

struct Square final : Shape {
  explicit Square(double length) : side{length} {}
  [[nodiscard]] double area() const override { return side * side; }
  [[nodiscard]] std::unique_ptr<Shape> copy() const override { return std::make_unique<Square>(*this); }
  double side;
};
struct Unique final : Shape {
  [[nodiscard]] double area() const override { return 0.0; }
  [[nodiscard]] std::unique_ptr<Shape> copy() const override { return nullptr; }
};

TEST(Owned, IsCopiedWithWhatItOwns) {
  Owned<Shape> one{std::make_unique<Square>(2.0)};
  Owned<Shape> other{one};
  EXPECT_NE(one.get(), other.get());
  EXPECT_EQ(other->area(), 4.0);
  dynamic_cast<Square&>(*one).side = 3.0;
  EXPECT_EQ(other->area(), 4.0);
  other = one;
  EXPECT_EQ(other->area(), 9.0);
  other = *&other;  // to itself
  EXPECT_EQ(other->area(), 9.0);
  const std::vector<Owned<Shape>> many(3, one);
  EXPECT_EQ(many[2]->area(), 9.0);
}

TEST(Owned, MovesWithoutACopy) {
  Owned<Shape> one{std::make_unique<Square>(2.0)};
  const Shape* const there = one.get();
  Owned<Shape> other{std::move(one)};
  EXPECT_EQ(other.get(), there);
}

TEST(Owned, IsEmptyWhereThereIsNoCopy) {
  const Owned<Shape> one{std::make_unique<Unique>()};
  const Owned<Shape> other{one};
  EXPECT_TRUE(static_cast<bool>(one));
  EXPECT_FALSE(static_cast<bool>(other));
  const Owned<Shape> nothing{nullptr};
  EXPECT_FALSE(static_cast<bool>(Owned<Shape>{nothing}));
}

}  // namespace
}  // namespace chicane
