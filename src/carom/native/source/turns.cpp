// Rotations and rigid transforms: kernels of quick calls, which `pybullet._maths.maths` also calls by ctypes.

#include <stdint.h>

#include "export.h"
#include "turns.h"

// The functions that kernels use; `flags.py` gives them names of their own.
extern "C" double sin(double);
extern "C" double cos(double);
extern "C" double asin(double);
extern "C" double acos(double);
extern "C" double atan2(double, double);
extern "C" double hypot(double, double);

#define CAROM_TURNS(name) extern "C" CAROM_EXPORT int carom_##name(const double* in, double* out, const void*)

namespace {

const double HALF_PI = 1.5707963267948966;
// Sine of the pitch from which on roll and yaw count as rotations about the same axis.
const double GIMBAL_LOCK = 0.99999;
// Ten times the spacing of single-precision numbers at 1.
const double NO_AXIS = 10.0 * 1.1920928955078125e-07;
// Tolerance of the squared length of a unit quaternion in single precision.
const double UNIT = 1e-6;

// Puts the only group of results; returns the number of groups.
template <typename Group>
int only(double* out, Group group) {
    put(out, group);
    return 1;
}

double length_of(Vector v) { return hypot(hypot(v.x, v.y), v.z); }
double to_cosine(double x) { return x > 1.0 ? 1.0 : x < -1.0 ? -1.0 : x; }

// The rotation from `start` to `end`, end · start⁻¹, with the sign of `end` that is nearer to `start`.
Quaternion difference(Quaternion start, Quaternion end) {
    return (dot(start, end) > 0.0 ? end : -end) * conjugate(start);
}

}  // namespace

CAROM_TURNS(quaternion_from_euler) {
    const double sr = sin(in[0] / 2.0), cr = cos(in[0] / 2.0);
    const double sp = sin(in[1] / 2.0), cp = cos(in[1] / 2.0);
    const double sy = sin(in[2] / 2.0), cy = cos(in[2] / 2.0);
    return only(
        out, unit({
                 sr * cp * cy - cr * sp * sy,
                 cr * sp * cy + sr * cp * sy,
                 cr * cp * sy - sr * sp * cy,
                 cr * cp * cy + sr * sp * sy,
             })
    );
}

CAROM_TURNS(euler_from_quaternion) {
    const double x = in[0], y = in[1], z = in[2], w = in[3];
    const double sine = -2.0 * (x * z - w * y);
    if (sine <= -GIMBAL_LOCK)
        return only(out, Vector{0.0, -HALF_PI, 2.0 * atan2(x, -y)});
    if (sine >= GIMBAL_LOCK)
        return only(out, Vector{0.0, HALF_PI, 2.0 * atan2(-x, y)});
    const double xx = x * x, yy = y * y, zz = z * z, ww = w * w;
    const double roll = atan2(2.0 * (y * z + w * x), ww - xx - yy + zz);
    return only(out, Vector{roll, asin(sine), atan2(2.0 * (x * y + w * z), ww + xx - yy - zz)});
}

CAROM_TURNS(matrix_from_quaternion) {
    const Matrix matrix = matrix_of(quaternion_at(in));
    for (const Vector& row : matrix.rows)
        out = put(out, row);
    return 1;
}

CAROM_TURNS(multiply_transforms) {
    const Quaternion turn = unit(quaternion_at(in + 3));
    const Quaternion product = turn * unit(quaternion_at(in + 10));
    put(put(out, vector_at(in) + turned(turn, vector_at(in + 7))), canonical(product));
    return 2;
}

CAROM_TURNS(invert_transform) {
    const Quaternion turn = canonical(unit(conjugate(quaternion_at(in + 3))));
    put(put(out, -turned(turn, vector_at(in))), turn);
    return 2;
}

CAROM_TURNS(rotate_vector) {
    const Quaternion q = quaternion_at(in);
    const Quaternion turned = q * Quaternion{in[4], in[5], in[6], 0.0} * conjugate(q);
    return only(out, Vector{turned.x, turned.y, turned.z});
}

CAROM_TURNS(quaternion_from_axis_angle) {
    const Vector axis = vector_at(in);
    const double half = 0.5 * in[3], length = length_of(axis);
    if (length == 0.0)
        return only(out, Quaternion{sin(half), 0.0, 0.0, cos(half)});
    const double s = sin(half) / length;
    return only(out, Quaternion{axis.x * s, axis.y * s, axis.z * s, cos(half)});
}

CAROM_TURNS(axis_angle_from_quaternion) {
    // Near the identity the result depends on the rounding of w to single precision, as in PyBullet.
    const double w = static_cast<float>(in[3]);
    const double sine_squared = 1.0 - w * w;
    out[3] = 2.0 * acos(to_cosine(w));
    if (sine_squared < NO_AXIS) {
        put(out, Vector{1.0, 0.0, 0.0});
        return 2;
    }
    const double s = 1.0 / __builtin_sqrt(sine_squared);
    put(out, Vector{in[0] * s, in[1] * s, in[2] * s});
    return 2;
}

CAROM_TURNS(quaternion_slerp) {
    const Quaternion a = quaternion_at(in), b = quaternion_at(in + 4);
    const double fraction = in[8], cosine = dot(a, b) / __builtin_sqrt(dot(a, a) * dot(b, b));
    if (__builtin_fabs(cosine) >= 1.0)
        return only(out, a);
    const double sign = cosine < 0.0 ? -1.0 : 1.0, angle = acos(sign * cosine);
    const double from_a = sin((1.0 - fraction) * angle) / sin(angle);
    const double from_b = sin(sign * fraction * angle) / sin(angle);
    return only(
        out, Quaternion{
                 a.x * from_a + b.x * from_b,
                 a.y * from_a + b.y * from_b,
                 a.z * from_a + b.z * from_b,
                 a.w * from_a + b.w * from_b,
             }
    );
}

CAROM_TURNS(difference_quaternion) { return only(out, difference(quaternion_at(in), quaternion_at(in + 4))); }

// In single precision and the order of operations of PyBullet: near a pitch of 90 degrees rounding decides.
CAROM_TURNS(axis_difference_quaternion) {
    float values[8];
    for (int i = 0; i < 8; ++i)
        values[i] = static_cast<float>(in[i]);
    const float a = -values[0], b = -values[1], c = -values[2], d = values[3];
    const float e = values[4], f = values[5], g = values[6], h = values[7];
    const float x = d * e + a * h + b * g - c * f, y = d * f + b * h + c * e - a * g;
    const float z = d * g + c * h + a * f - b * e, w = d * h - a * e - b * f - c * g;
    const float s = 2.0f / (x * x + y * y + z * z + w * w);
    const float xs = x * s, ys = y * s, zs = z * s;
    const float wx = w * xs, wy = w * ys, wz = w * zs;
    const float xx = x * xs, xy = x * ys, xz = x * zs, yy = y * ys, yz = y * zs, zz = z * zs;
    const float sine = xz - wy;
    if (sine >= 1.0f)
        return only(out, Vector{atan2(xy - wz, 1.0f - (xx + zz)), HALF_PI, 0.0});
    if (sine <= -1.0f)
        return only(out, Vector{-atan2(xy - wz, 1.0f - (xx + zz)), -HALF_PI, 0.0});
    return only(
        out, Vector{
                 atan2(-(yz + wx), 1.0f - (xx + yy)),
                 asin(sine),
                 atan2(-(xy + wz), 1.0f - (yy + zz)),
             }
    );
}

// Declines if the duration is too short for a finite velocity.
CAROM_TURNS(velocity_quaternion) {
    const Quaternion turn = difference(quaternion_at(in), quaternion_at(in + 4));
    const double duration = in[8], sine = length_of({turn.x, turn.y, turn.z}), w = turn.w;
    if (sine == 0.0)
        return only(out, Vector{0.0, 0.0, 0.0});
    // If quaternions do not have unit length, PyBullet computes the angle from w alone.
    const bool is_unit = __builtin_fabs(sine * sine + w * w - 1.0) < UNIT;
    const double angle = 2.0 * (is_unit ? atan2(sine, w) : acos(to_cosine(w)));
    const double scale = angle / (sine * duration);
    if (!__builtin_isfinite(scale))
        return 0;
    return only(out, Vector{turn.x * scale, turn.y * scale, turn.z * scale});
}
