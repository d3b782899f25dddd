// Sine, cosine and tangent: musl's reduction of angles and musl's polynomials.

#include "libm.h"

#define EIGHTH_TURN 0.78539816339744828
// The squares of smaller numbers vanish when added to 1.
#define TINY 0x1p-27

// A reduced angle: at most an eighth of a turn, as a sum whose second part is smaller than the rounding error of the
// first; and the number of quarter turns between it and the original angle.
struct angle {
    double high, low;
    int quarters, reduced;
};

static struct angle reduce(double x)
{
    double rest[2];
    int quarters;
    if (fabs(x) <= EIGHTH_TURN)
        return (struct angle) { x, 0.0, 0, 0 };
    if (!isfinite(x))
        return (struct angle) { NAN, NAN, 0, 1 };
    quarters = __rem_pio2(x, rest);
    return (struct angle) { rest[0], rest[1], quarters, 1 };
}

// The sine of an angle plus `quarters` quarter turns: a cosine if the number is odd, and negated after two.
static double sine(struct angle angle, int quarters)
{
    double value = quarters & 1 ? __cos(angle.high, angle.low) : __sin(angle.high, angle.low, angle.reduced);
    return quarters & 2 ? -value : value;
}

double sin(double x)
{
    if (fabs(x) < TINY)
        return x;
    struct angle angle = reduce(x);
    return sine(angle, angle.quarters);
}

double cos(double x)
{
    struct angle angle = reduce(x);
    return sine(angle, angle.quarters + 1);
}

double tan(double x)
{
    if (fabs(x) < TINY)
        return x;
    struct angle angle = reduce(x);
    return __tan(angle.high, angle.low, angle.quarters & 1);
}
