// Elements of the arrays of kernels, in place of Warp's functions of the same names.
//
// Warp counts negative indices from the end of an axis, and allows any distance between the elements of each axis. No
// kernel has negative indices, and the elements of the last axis of our arrays are next to each other. So an element of
// a vector costs an addition, and one of a matrix another multiplication. Kernels consist of such accesses for the most
// part: without the unused cases they keep less in registers and on the stack.
#pragma once

namespace carom {

template <typename T>
inline T& index(const wp::array_t<T>& array, int i) {
    return array.data[i];
}

template <typename T>
inline T& index(const wp::array_t<T>& array, int i, int j) {
    char* row = reinterpret_cast<char*>(array.data) + static_cast<int64_t>(i) * array.strides[0];
    return reinterpret_cast<T*>(row)[j];
}

template <typename T, typename... Indices>
inline T* address(const wp::array_t<T>& array, Indices... indices) {
    return &carom::index(array, indices...);
}

template <typename T, typename V>
inline void array_store(const wp::array_t<T>& array, int i, const V& value) {
    carom::index(array, i) = value;
}

template <typename T, typename V>
inline void array_store(const wp::array_t<T>& array, int i, int j, const V& value) {
    carom::index(array, i, j) = value;
}

}  // namespace carom
