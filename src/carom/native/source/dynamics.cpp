// Changing contact parameters and masses of links, and parameters of bodies: a kernel of quick calls.

#include "export.h"
#include "quick_calls.h"

namespace {

using namespace change_dynamics;

bool is_given(double number) { return number == number; }

// Whether an argument is given that only Python handles.
bool has_others(const double* in) {
    for (int place : OTHERS)
        if (in[place] != (place == JOINT_LOWER_LIMIT ? 1.0 : -1.0))
            return true;
    return is_given(in[ANISOTROPIC_FRICTION]);
}

// Whether any of some arguments is given.
template <int count>
bool has_one(const double* in, const int (&places)[count]) {
    for (int place : places)
        if (in[place] >= 0.0)
            return true;
    return false;
}

// Sets an attribute of the host's copy of these properties; false if memory is short.
bool tell(PyObject* dynamics, PyObject* name, PyObject* value) {
    const bool well = value && !python.PyObject_SetAttr(dynamics, name, value);
    if (!well)
        python.PyErr_Clear();
    return well;
}

bool tell(PyObject* dynamics, PyObject* name, double number) {
    PyObject* value = python.PyFloat_FromDouble(number);
    const bool well = tell(dynamics, name, value);
    if (value)
        python.Py_DecRef(value);
    return well;
}

double moment(const Moments& of, int axis, double mass) {
    double sum = 0.0;
    for (const auto& term : of.terms[axis])
        sum += mass / term.divisor * term.factors[0] * term.factors[1] * term.factors[2];
    return sum;
}

bool is_held(const Scene& scene, const Body& body) {
    PyObject* held = python.PyObject_GetAttr(body.handle, scene.fixed_base_name);
    const bool is_free = held == python.False;
    release(held);
    return !is_free;
}

// Changes the mass of a link, or its moments of inertia alone; false if Python has to handle it: if a base is fixed or
// freed, or if there are data derived from masses. Fills `tuple`, a new one of three items, with the moments.
bool change_mass(const double* in, const Scene& scene, const Body& body, PyObject* dynamics, PyObject* tuple) {
    const int64_t link = static_cast<int64_t>(in[LINK_INDEX]), row = body.first_link + link + 1;
    const bool has_mass = in[MASS] >= 0.0, has_inertia = is_given(in[LOCAL_INERTIA_DIAGONAL]);
    double moments[3] = {in[LOCAL_INERTIA_DIAGONAL], in[LOCAL_INERTIA_DIAGONAL + 1], in[LOCAL_INERTIA_DIAGONAL + 2]};
    if (python.PyDict_Size(body.derived))
        return false;
    if (has_mass && (in[MASS] == 0.0 || (link < 0 && is_held(scene, body))))
        return false;
    if (!has_inertia) {
        if (!body.moments || !body.moments[link + 1].is_known)
            return false;
        for (int axis = 0; axis < 3; ++axis)
            moments[axis] = moment(body.moments[link + 1], axis, in[MASS]);
    }
    for (int axis = 0; axis < 3; ++axis) {
        PyObject* number = python.PyFloat_FromDouble(moments[axis]);
        if (!number) {
            python.PyErr_Clear();
            return false;
        }
        python.PyTuple_SetItem(tuple, axis, number);
    }
    if (!tell(dynamics, scene.inertia_name, tuple) || (has_mass && !tell(dynamics, scene.mass_name, in[MASS])))
        return false;
    for (int axis = 0; axis < 3; ++axis)
        scene.inertia[3 * row + axis] = moments[axis];
    if (has_mass)
        scene.mass[row] = in[MASS];
    return true;
}

bool change(const double* in, const Client& client, const Body& body, PyObject* moments) {
    const Scene& scene = *client.scene;
    const Lock lock(client);
    if (!lock.is_held || !scene.find_poses.call.function)
        return false;
    for (int i = 0; i < OF_BODY_COUNT; ++i)
        if (in[OF_BODY[i]] >= 0.0)
            scene.of_body[i][body.tree] = in[OF_BODY[i]];
    const int64_t link = static_cast<int64_t>(in[LINK_INDEX]);
    const int64_t row = body.first_link + link + 1;
    PyObject* dynamics = python.PyList_GetItem(body.dynamics, link + 1);
    if (moments && !change_mass(in, scene, body, dynamics, moments))
        return false;
    for (int i = 0; i < SURFACE_COUNT; ++i)
        if (in[OF_SURFACE[i]] >= 0.0) {
            if (!tell(dynamics, scene.surface_names[i], in[OF_SURFACE[i]]))
                return false;
            // All shapes of a link of the drop-in have one surface.
            const int32_t first = scene.surface_first[row];
            for (int32_t shape = first; shape < first + scene.surface_shapes[row]; ++shape)
                scene.surface[i][shape] = in[OF_SURFACE[i]];
            if (OF_SURFACE[i] == LATERAL_FRICTION)
                scene.node_friction[row] = in[LATERAL_FRICTION];
        }
    return true;
}

}  // namespace

// Arguments: those of `changeDynamics`. Python handles those in `OTHERS`, anisotropic friction, and calls that change
// parameters of a link together with those of the body.
extern "C" CAROM_EXPORT int carom_change_dynamics(const double* in, double* out, const Call* call) {
    const bool of_mass = in[MASS] >= 0.0 || is_given(in[LOCAL_INERTIA_DIAGONAL]), of_body = has_one(in, OF_BODY);
    if (has_others(in) || ((of_mass || has_one(in, OF_SURFACE)) && of_body))
        return 0;
    if ((in[CONTACT_STIFFNESS] >= 0.0) != (in[CONTACT_DAMPING] >= 0.0))
        return 0;
    // The body is looked up after making the tuple, which can start garbage collection, which may run any code.
    PyObject* moments = of_mass ? python.PyTuple_New(3) : nullptr;
    if (of_mass && !moments) {
        python.PyErr_Clear();
        return 0;
    }
    const Client* client = find_client(in[PHYSICS_CLIENT_ID]);
    const Body* body = client ? find_body(*client, in[BODY_UNIQUE_ID]) : nullptr;
    const bool well = body && has_link(*body, in[LINK_INDEX]) && change(in, *client, *body, moments);
    if (moments)
        python.Py_DecRef(moments);
    return well;
}
