// Quaternions (x, y, z, w) and vectors, with the same order of operations as `pybullet._maths.rotations`.
#pragma once

struct Vector {
    double x, y, z;
};

struct Quaternion {
    double x, y, z, w;
};

inline Vector vector_at(const double* at) { return {at[0], at[1], at[2]}; }
inline Quaternion quaternion_at(const double* at) { return {at[0], at[1], at[2], at[3]}; }

inline double* put(double* at, Vector v) {
    at[0] = v.x, at[1] = v.y, at[2] = v.z;
    return at + 3;
}

inline double* put(double* at, Quaternion q) {
    at[0] = q.x, at[1] = q.y, at[2] = q.z, at[3] = q.w;
    return at + 4;
}

inline Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector operator*(double s, Vector v) { return {s * v.x, s * v.y, s * v.z}; }
inline Vector operator-(Vector v) { return {-v.x, -v.y, -v.z}; }
inline Quaternion operator-(Quaternion q) { return {-q.x, -q.y, -q.z, -q.w}; }
inline Quaternion conjugate(Quaternion q) { return {-q.x, -q.y, -q.z, q.w}; }

inline Vector cross(Vector a, Vector b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline double dot(Quaternion a, Quaternion b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }

// The rotation b followed by a.
inline Quaternion operator*(Quaternion a, Quaternion b) {
    return {
        a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
        a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z,
        a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x,
        a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
    };
}

inline Quaternion unit(Quaternion q) {
    const double length = __builtin_sqrt(dot(q, q));
    return {q.x / length, q.y / length, q.z / length, q.w / length};
}

struct Matrix {
    Vector rows[3];
};

// The rotation matrix of a quaternion, which need not have unit length; with the same order of operations as
// `carom.description.transform.rotation_matrix`.
inline Matrix matrix_of(Quaternion q) {
    const double s = 2.0 / dot(q, q);
    const double xs = q.x * s, ys = q.y * s, zs = q.z * s;
    const double wx = q.w * xs, wy = q.w * ys, wz = q.w * zs;
    const double xx = q.x * xs, xy = q.x * ys, xz = q.x * zs;
    const double yy = q.y * ys, yz = q.y * zs, zz = q.z * zs;
    return {{
        {1.0 - (yy + zz), xy - wz, xz + wy},
        {xy + wz, 1.0 - (xx + zz), yz - wx},
        {xz - wy, yz + wx, 1.0 - (xx + yy)},
    }};
}

// A vector rotated by a unit quaternion.
inline Vector turned(Quaternion q, Vector v) {
    const double tx = 2.0 * (q.y * v.z - q.z * v.y);
    const double ty = 2.0 * (q.z * v.x - q.x * v.z);
    const double tz = 2.0 * (q.x * v.y - q.y * v.x);
    return {
        v.x + q.w * tx + q.y * tz - q.z * ty,
        v.y + q.w * ty + q.z * tx - q.x * tz,
        v.z + q.w * tz + q.x * ty - q.y * tx,
    };
}

// Of the two quaternions of a rotation, the one that PyBullet reports: w is positive if the trace of the rotation
// matrix is; otherwise the component of x, y and z with the largest magnitude is positive.
inline Quaternion canonical(Quaternion q) {
    double leading = q.w;
    if (!(q.w * q.w > 0.25)) {
        leading = q.x;
        if (__builtin_fabs(q.y) > __builtin_fabs(leading))
            leading = q.y;
        if (__builtin_fabs(q.z) > __builtin_fabs(leading))
            leading = q.z;
    }
    return leading < 0.0 ? -q : q;
}
