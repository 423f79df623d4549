// Snell's law in vector form, for directions scaled by the index: the tangential part of n s is continuous.

struct Refraction {
    uint transmitted; // 0: total internal reflection
    real3 direction;  // of length index_after
};

// direction of length index_before, direction.z > 0; normal of any length on the side direction points to.
// n's' = n s + gamma N with gamma = -p + sqrt(n'^2 - n^2 + p^2), p = n s . N for a unit N; written as a quotient so that
// equal indices give exactly zero. The axial part is recomputed from the index: the drift of the direction's
// length is the dominant error in float.
VKFV_FUNCTION Refraction refract_scaled(real3 direction, real3 normal, real index_before, real index_after) {
    real normal_squared = dot(normal, normal);
    real p = dot(direction, normal); // |N| n cos(theta)
    real difference = (index_after * index_after - index_before * index_before) * normal_squared;
    real under_root = p * p + difference;
    Refraction result;
    result.transmitted = under_root >= real(0.0) ? 1u : 0u;
    real gamma = difference / ((p + sqrt(max(under_root, real(0.0)))) * normal_squared);
    real x = direction.x + gamma * normal.x;
    real y = direction.y + gamma * normal.y;
    real axial = index_after * index_after - x * x - y * y;
    // A ray that would travel at right angles to the axis or backward has left the sequential model.
    result.transmitted = axial > real(0.0) ? result.transmitted : 0u;
    result.direction = real3(x, y, sqrt(max(axial, real(1e-30))));
    return result;
}
