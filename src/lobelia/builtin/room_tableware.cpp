// What stands on the table of the dining room: six places, candles, a bowl of fruit.
#include <fmt/format.h>

#include <cmath>

#include "lobelia/builtin/dining_room.h"
#include "lobelia/builtin/shapes.h"
#include "lobelia/builtin/solids.h"
#include "lobelia/builtin/sweep.h"

namespace lobelia::builtin {

void DiningRoom::addPlaces() {
  const MeshHandle plate = add(revolve(smoothCurve({{0, 0},
                                                    {0.07f, 0},
                                                    {0.078f, 0.004f},
                                                    {0.10f, 0.010f},
                                                    {0.135f, 0.020f},
                                                    {0.137f, 0.023f},
                                                    {0.133f, 0.024f},
                                                    {0.10f, 0.014f},
                                                    {0.075f, 0.008f},
                                                    {0, 0.007f}}),
                                       segments(27, 9), segments(56, 12)),
                               "plate");
  const MeshHandle goblet = add(turned({{0, 0},
                                        {0.030f, 0},
                                        {0.034f, 0.003f},
                                        {0.012f, 0.010f},
                                        {0.0045f, 0.022f},
                                        {0.0045f, 0.08f},
                                        {0.014f, 0.092f},
                                        {0.034f, 0.115f},
                                        {0.040f, 0.145f},
                                        {0.034f, 0.195f},
                                        {0.0333f, 0.197f},
                                        {0.0325f, 0.195f},
                                        {0.0385f, 0.145f},
                                        {0.0325f, 0.116f},
                                        {0.012f, 0.095f},
                                        {0, 0.094f}},
                                       segments(45, 15), segments(40, 10)),
                                "wine glass");
  const MeshHandle knife = add(block({0.010f, 0.0018f, 0.11f}, 0.0015f), "knife");
  const MeshHandle handle =
      add(superellipsoid({0.008f, 0.005f, 0.05f}, 0.8f, 0.6f, segments(8, 4), segments(16, 6)),
          "handle");
  const MeshHandle napkin = add(block({0.05f, 0.006f, 0.09f}, 0.005f), "napkin");
  const double y = kTableTop;
  const struct {
    double x, z, turn;
  } seats[] = {{-0.55, -0.34, 0}, {0.52, -0.34, 0}, {-0.52, 0.34, 180},
               {0.55, 0.34, 180}, {-0.86, 0, 90},   {0.86, 0, -90}};
  for (int i = 0; i < 6; ++i) {
    // x to the guest's left, z to the middle of the table.
    const Mat4 at = translation({seats[i].x, y, seats[i].z}) * rotation({0, 1, 0}, seats[i].turn);
    const auto name = [&](const char* what) { return fmt::format("place {}, {}", i + 1, what); };
    place(plate, at, porcelain_, name("plate"));
    place(plate, at * translation({0, 0.0215, 0}) * scaling({0.72, 0.9, 0.72}), glaze_,
          name("small plate"));
    place(goblet, at * translation({-0.13, 0, 0.15}), crystal_, name("glass"));
    place(goblet, at * translation({-0.05, 0, 0.185}) * scaling(Vec3d(0.85)), crystal_,
          name("small glass"));
    for (const int s : {-1, 1}) {
      const char* side = s < 0 ? "right" : "left";
      place(knife, at * translation({0.165 * s, 0.002, 0.03}), silver_,
            fmt::format("place {}, {} blade", i + 1, side));
      place(handle, at * translation({0.165 * s, 0.005, -0.07}), silver_,
            fmt::format("place {}, {} handle", i + 1, side));
    }
    place(napkin, at * translation({0.22, 0.006, -0.01}), linen_, name("napkin"));
  }
}

void DiningRoom::candle(Vec3d at, double height, const std::string& name) {
  if (!stick_.valid()) {
    stick_ = add(revolve(smoothCurve({{0, 0},
                                      {0.045f, 0},
                                      {0.05f, 0.008f},
                                      {0.03f, 0.02f},
                                      {0.012f, 0.04f},
                                      {0.018f, 0.07f},
                                      {0.010f, 0.10f},
                                      {0.010f, 0.15f},
                                      {0.020f, 0.175f},
                                      {0.012f, 0.19f},
                                      {0.024f, 0.21f},
                                      {0.022f, 0.216f},
                                      {0, 0.214f}}),
                         segments(60, 12), segments(36, 8)),
                 "candlestick");
    candle_ = add(cylinder(0.0105f, 1, 0.003f, 2, segments(24, 6)), "candle");
    flame_ =
        add(superellipsoid({0.0065f, 0.020f, 0.0065f}, 1.25f, 1, segments(14, 4), segments(16, 6)),
            "flame");
    glow_ = glow(Rgb(320, 190, 75), "candle light");
  }
  place(stick_, translation(at), silver_, name + ", stick");
  place(candle_, translation(at + Vec3d(0, 0.213, 0)) * scaling({1, height, 1}), wax_, name);
  place(flame_, translation(at + Vec3d(0, 0.213 + height + 0.024, 0)), black_, name + ", flame",
        glow_);
}

void DiningRoom::addCentre() {
  candle({-0.32, kTableTop + 0.003, 0.01}, 0.16, "candle 1");
  candle({0.33, kTableTop + 0.003, -0.02}, 0.13, "candle 2");
  put(revolve(smoothCurve({{0, 0},
                           {0.05f, 0},
                           {0.06f, 0.006f},
                           {0.05f, 0.02f},
                           {0.09f, 0.045f},
                           {0.145f, 0.085f},
                           {0.165f, 0.10f},
                           {0.16f, 0.105f},
                           {0.13f, 0.085f},
                           {0.08f, 0.052f},
                           {0, 0.042f}}),
              segments(50, 10), segments(72, 12)),
      {0, kTableTop + 0.003, 0}, silver_, "bowl");
  const MeshHandle fruit = add(ball(1, segments(24, 6), segments(40, 8)), "fruit");
  const MaterialHandle orange = add(coated(Rgb(0.62f, 0.22f, 0.02f), 0.3f), "orange"),
                       apple = add(coated(Rgb(0.42f, 0.03f, 0.02f), 0.12f), "apple"),
                       pear = add(coated(Rgb(0.38f, 0.40f, 0.05f), 0.2f), "pear");
  const MaterialHandle kinds[] = {orange, apple, pear};
  for (int i = 0; i < 7; ++i) {
    const double a = 60.0 * i * static_cast<double>(kPi) / 180, r = i < 6 ? 0.075 : 0;
    place(fruit,
          translation({r * std::cos(a), kTableTop + (i < 6 ? 0.115 : 0.165), r * std::sin(a)}) *
              scaling({0.037, 0.035, 0.037}),
          kinds[i % 3], fmt::format("fruit {}", i + 1));
  }
}

}  // namespace lobelia::builtin
