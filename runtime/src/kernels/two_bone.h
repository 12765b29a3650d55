// Two bones in closed form. Included in an unnamed namespace by one source for each kind of Number: a double, or
// several in lanes, one per limb. The source also defines Mask, a boolean per lane, and the functions of both. All of
// them round every operation, so that a lane computes the same bits as a single limb.

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

struct Vector {
    Number x, y, z;
};

struct Rotation {
    Number x, y, z, w;
};

BENDY_ALWAYS_INLINE Vector operator+(const Vector& a, const Vector& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
BENDY_ALWAYS_INLINE Vector operator-(const Vector& a, const Vector& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
BENDY_ALWAYS_INLINE Vector operator*(const Vector& v, Number number) {
    return {v.x * number, v.y * number, v.z * number};
}
BENDY_ALWAYS_INLINE Vector scaled(const Vector& a, const Vector& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
BENDY_ALWAYS_INLINE Number dot(const Vector& a, const Vector& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
BENDY_ALWAYS_INLINE Vector cross(const Vector& a, const Vector& b) {
    return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
}
BENDY_ALWAYS_INLINE Number squared(const Vector& v) {
    return dot(v, v);
}
BENDY_ALWAYS_INLINE Number squared(const Rotation& q) {
    return q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
}
BENDY_ALWAYS_INLINE Rotation operator*(const Rotation& q, Number number) {
    return {q.x * number, q.y * number, q.z * number, q.w * number};
}
BENDY_ALWAYS_INLINE Rotation operator*(const Rotation& a, const Rotation& b) {
    return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z,
            a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}
BENDY_ALWAYS_INLINE Rotation conjugate(const Rotation& q) {
    return {-q.x, -q.y, -q.z, q.w};
}
BENDY_ALWAYS_INLINE Vector chosen(Mask mask, const Vector& a, const Vector& b) {
    return {chosen(mask, a.x, b.x), chosen(mask, a.y, b.y), chosen(mask, a.z, b.z)};
}
BENDY_ALWAYS_INLINE Rotation chosen(Mask mask, const Rotation& a, const Rotation& b) {
    return {chosen(mask, a.x, b.x), chosen(mask, a.y, b.y), chosen(mask, a.z, b.z), chosen(mask, a.w, b.w)};
}

/// Rotates a vector by a unit quaternion.
BENDY_ALWAYS_INLINE Vector turned(const Rotation& q, const Vector& v) {
    const Vector u{q.x, q.y, q.z};
    const Vector across = cross(u, v) * 2.0;
    return v + across * q.w + cross(u, across);
}

/// Normalises a quaternion. False for a zero quaternion and for NaN.
BENDY_ALWAYS_INLINE Mask normalize(Rotation& q) {
    const Number length = squared(q);
    q = q * (1.0 / root(length));
    constexpr double kLeast = 1e-200, kMost = 1e200;
    return both(length > Number(kLeast), length < Number(kMost));
}

/// Normalises a joint's rotation; false if its length is off by more than rounding.
BENDY_ALWAYS_INLINE Mask normalize_local(Rotation& q) {
    const Number off = squared(q) - 1.0;
    constexpr double kMost = 1e-5;
    q = q * (1.0 - 0.5 * off);
    return absolute(off) < Number(kMost);
}

/// Computes the unit normal of the plane through two directions; false if they are (nearly) parallel.
BENDY_ALWAYS_INLINE Mask find_normal(const Vector& a, const Vector& b, Vector& normal) {
    constexpr double kClear = 1e-12;
    normal = cross(a, b);
    const Number size = squared(normal);
    normal = normal * (1.0 / root(size));
    return size > kClear * squared(a) * squared(b);
}

/// Returns the rotation with these unit x, y and z axes, with the sign nearest to `like`. By Shepperd, "Quaternion from
/// Rotation Matrix", 1978.
BENDY_ALWAYS_INLINE Rotation rotation_of(const Vector& x, const Vector& y, const Vector& z, const Rotation& like) {
    const Number by_x = x.x - y.y - z.z, by_y = y.y - x.x - z.z, by_z = z.z - x.x - y.y, by_w = x.x + y.y + z.z;
    const Mask is_x = by_x > by_w, is_z_or_y = greater(by_y, by_z) > greater(by_x, by_w), is_z = by_z > by_y;
    const Number most = greater(greater(by_x, by_w), greater(by_y, by_z)) + 1.0;
    const Number less_x = y.z - z.y, less_y = z.x - x.z, less_z = x.y - y.x;
    const Number xy = x.y + y.x, xz = z.x + x.z, yz = y.z + z.y;
    const Rotation of_w_or_x = chosen(is_x, Rotation{most, xy, xz, less_x}, Rotation{less_x, less_y, less_z, most});
    const Rotation of_y_or_z = chosen(is_z, Rotation{xz, yz, most, less_z}, Rotation{xy, most, yz, less_y});
    const Rotation q = chosen(is_z_or_y, of_y_or_z, of_w_or_x);
    const Number scale = 0.5 / root(most);
    const Number same = q.w * like.w + q.x * like.x + q.y * like.y + q.z * like.z;
    return q * chosen(same < Number(0.0), -scale, scale);
}

/// A vector at right angles to a unit axis, turned about it.
BENDY_ALWAYS_INLINE Vector rolled(const Vector& v, const Vector& axis, Number cosine, Number sine) {
    return v * cosine + cross(axis, v) * sine;
}

/// Whether all axes have one scale, to within `same` of it.
BENDY_ALWAYS_INLINE Mask is_even(const Vector& scale, Number same) {
    return both(scale.x > Number(0.0),
                both(absolute(scale.x - scale.y) <= same * scale.x, absolute(scale.x - scale.z) <= same * scale.x));
}

BENDY_ALWAYS_INLINE Number mean_of(const Vector& v) {
    return (v.x + v.y + v.z) / 3.0;
}

struct Limb {
    Vector base[4];
    Vector target, pole;
    Rotation upper, lower;
    Vector origin, middle, tip, upper_scale, lower_scale, axis;
    Number same_scale, tolerance, roll_cosine, roll_sine;
    Mask has_pole, is_pole_point, is_rolled, is_fixed, prefers_back;
};

/// Quantities derived from a limb.
struct Reaching {
    Vector way;       ///< start to target, in base space
    Number distance;  ///< its squared length
    Vector rest;      ///< middle to tip, in the start's space
    Rotation upper, lower;
};

/// How the middle joint bends: the rest of the chain rotates about a unit axis, relative to the start.
struct Bend {
    Vector bone;     ///< start to middle
    Vector axis;     ///< of the rotation
    Vector across;   ///< middle to tip: the part that rotates
    Vector along;    ///< middle to tip: the part along the axis
    Number b, c;     ///< component of the rotated `across` along the bone, at an angle: b cos + c sin
    Number wanted;   ///< the required value of that
    Number most;     ///< b^2 + c^2
    Number opening;  ///< sqrt(most - wanted^2): the opening to either side of the straight chain
};

struct Turn {
    Number cosine, sine;
};

using Limbs = TwoBoneLimbs<kLimbs>;

template <std::size_t count>
BENDY_ALWAYS_INLINE Number load_number(const Limbs& limbs, const double (Limbs::*member)[count][kLimbs],
                                       std::size_t number) {
    return loaded((limbs.*member)[number]);
}

BENDY_ALWAYS_INLINE Vector load_vector(const Limbs& limbs, const double (Limbs::*member)[3][kLimbs]) {
    return {load_number(limbs, member, 0), load_number(limbs, member, 1), load_number(limbs, member, 2)};
}

BENDY_ALWAYS_INLINE Rotation load_rotation(const Limbs& limbs, const double (Limbs::*member)[4][kLimbs]) {
    return {load_number(limbs, member, 0), load_number(limbs, member, 1), load_number(limbs, member, 2),
            load_number(limbs, member, 3)};
}

BENDY_ALWAYS_INLINE Mask load_flag(const Limbs& limbs, const double (Limbs::*member)[1][kLimbs]) {
    return load_number(limbs, member, 0) > Number(0.0);
}

BENDY_ALWAYS_INLINE Limb load_limb(const Limbs& limbs) {
    Limb limb;
    limb.base[0] = load_vector(limbs, &Limbs::base_x);
    limb.base[1] = load_vector(limbs, &Limbs::base_y);
    limb.base[2] = load_vector(limbs, &Limbs::base_z);
    limb.base[3] = load_vector(limbs, &Limbs::base_origin);
    limb.target = load_vector(limbs, &Limbs::target);
    limb.pole = load_vector(limbs, &Limbs::pole);
    limb.upper = load_rotation(limbs, &Limbs::upper);
    limb.lower = load_rotation(limbs, &Limbs::lower);
    limb.origin = load_vector(limbs, &Limbs::origin);
    limb.middle = load_vector(limbs, &Limbs::middle);
    limb.tip = load_vector(limbs, &Limbs::tip);
    limb.upper_scale = load_vector(limbs, &Limbs::upper_scale);
    limb.lower_scale = load_vector(limbs, &Limbs::lower_scale);
    limb.axis = load_vector(limbs, &Limbs::axis);
    limb.same_scale = load_number(limbs, &Limbs::same_scale, 0);
    limb.tolerance = load_number(limbs, &Limbs::tolerance, 0);
    limb.roll_cosine = load_number(limbs, &Limbs::roll, 0);
    limb.roll_sine = load_number(limbs, &Limbs::roll, 1);
    limb.has_pole = load_flag(limbs, &Limbs::has_pole);
    limb.is_pole_point = load_flag(limbs, &Limbs::is_pole_point);
    limb.is_rolled = load_flag(limbs, &Limbs::is_rolled);
    limb.is_fixed = load_flag(limbs, &Limbs::is_fixed);
    limb.prefers_back = load_flag(limbs, &Limbs::prefers_back);
    return limb;
}

/// Converts a point from model space to base space; not finite if the base is flat.
BENDY_ALWAYS_INLINE Vector from_model(const Vector* base, const Vector& point) {
    const Vector way = point - base[3];
    const Vector across = cross(base[1], base[2]);
    const Number volume = 1.0 / dot(base[0], across);
    return Vector{dot(way, across), dot(way, cross(base[2], base[0])), dot(way, cross(base[0], base[1]))} * volume;
}

/// Returns the tolerance in base space, given that in metres, if there is one, and the limb's length in base space.
BENDY_ALWAYS_INLINE Number tolerance_in(const Vector* base, Number metres, Number length) {
    constexpr double kOfLength = 1e-4, kLeast = 1e-9;
    const Number scale = greater(squared(base[0]), greater(squared(base[1]), squared(base[2])));
    return chosen(metres > Number(0.0), greater(metres / root(scale), kLeast * length), kOfLength * length);
}

/// Finds the bones and the way to the target. False if these are not two bones of even scale.
BENDY_ALWAYS_INLINE Mask begin(const Limb& limb, Reaching& reach, Bend& bend) {
    reach.upper = limb.upper;
    reach.lower = limb.lower;
    const Mask are_units = both(normalize_local(reach.upper), normalize_local(reach.lower));
    reach.way = from_model(limb.base, limb.target) - limb.origin;
    reach.distance = squared(reach.way);
    bend.axis = limb.axis;
    bend.bone = scaled(limb.upper_scale, limb.middle);
    reach.rest = turned(reach.lower, scaled(limb.lower_scale * mean_of(limb.upper_scale), limb.tip));
    return both(are_units,
                both(is_even(limb.upper_scale, limb.same_scale), is_even(limb.lower_scale, limb.same_scale)));
}

constexpr double kStraight = 1e-8;

/// Finds a bend about the normal of the limb as it is; false if that is straight.
BENDY_ALWAYS_INLINE Mask find_free_bend(const Vector& rest, Number sizes, Bend& bend) {
    const Vector normal = cross(bend.bone, rest);
    const Number size = squared(normal);
    const Number length = root(size);
    bend.across = rest;
    bend.along = {0.0, 0.0, 0.0};
    bend.c = -length;
    bend.axis = normal * (1.0 / length);
    bend.b = dot(bend.bone, rest);
    bend.most = sizes;
    return size > kStraight * sizes;
}

/// Finds a bend about the axis that is set.
BENDY_ALWAYS_INLINE void find_fixed_bend(const Vector& rest, Bend& bend) {
    bend.along = bend.axis * dot(rest, bend.axis);
    bend.across = rest - bend.along;
    bend.b = dot(bend.bone, bend.across);
    bend.c = dot(bend.bone, cross(bend.axis, bend.across));
    bend.most = bend.b * bend.b + bend.c * bend.c;
}

/// Completes a bend whose `bone` and, if it is fixed, `axis` are set. False if the limb is straight or cannot have the
/// length that it needs.
BENDY_ALWAYS_INLINE Mask find_bend(const Reaching& reach, Mask is_fixed, Bend& bend) {
    const Number sizes = squared(bend.bone) * squared(reach.rest);
    Mask is_bent = is_fixed;
    Bend fixed = bend;
    if (is_any(is_fixed)) find_fixed_bend(reach.rest, fixed);
    if (!is_every(is_fixed)) is_bent = either(find_free_bend(reach.rest, sizes, bend), is_bent);
    bend.axis = chosen(is_fixed, fixed.axis, bend.axis);
    bend.across = chosen(is_fixed, fixed.across, bend.across);
    bend.along = chosen(is_fixed, fixed.along, bend.along);
    bend.b = chosen(is_fixed, fixed.b, bend.b);
    bend.c = chosen(is_fixed, fixed.c, bend.c);
    bend.most = chosen(is_fixed, fixed.most, bend.most);
    const Number along = dot(bend.bone, bend.along);
    bend.wanted = 0.5 * (reach.distance - squared(bend.bone) - squared(reach.rest)) - along;
    const Number left = bend.most - bend.wanted * bend.wanted;
    bend.opening = root(left);
    return both(is_bent, both(bend.most > kStraight * sizes, left > kStraight * bend.most));
}

/// Returns the rotations to either side: the smaller one first, or the preferred one if they are equal. Without a fixed
/// axis, both are the one that needs no rotation of the start by half a revolution.
BENDY_ALWAYS_INLINE void find_turns(const Bend& bend, Mask is_fixed, Mask prefers_back, Turn* turns) {
    const Number share = 1.0 / bend.most;
    const Number b = bend.b * bend.wanted, c = bend.c * bend.opening;
    const Number d = bend.c * bend.wanted, e = bend.b * bend.opening;
    const Turn back{(b - c) * share, (d + e) * share};
    const Turn ahead{(b + c) * share, (d - e) * share};
    constexpr double kSame = 1e-6;
    const Number gain = ahead.cosine - back.cosine;
    const Mask is_ahead = both(is_fixed, chosen(absolute(gain) > Number(kSame), gain > Number(0.0), prefers_back));
    turns[0] = {chosen(is_ahead, ahead.cosine, back.cosine), chosen(is_ahead, ahead.sine, back.sine)};
    const Mask is_other = both(is_fixed, opposite(is_ahead));
    turns[1] = {chosen(is_other, ahead.cosine, back.cosine), chosen(is_other, ahead.sine, back.sine)};
}

/// Computes the middle joint's rotation after the turn; false if the turn is half a revolution.
BENDY_ALWAYS_INLINE Mask turn_middle(const Bend& bend, const Turn& turn, const Rotation& before, Rotation& after) {
    const Vector by = bend.axis * turn.sine;
    const Number open = 1.0 + turn.cosine;
    after = Rotation{by.x, by.y, by.z, open} * before;
    constexpr double kHalfAround = 1e-9;
    const Mask is_whole = normalize(after);
    return both(is_whole, open > Number(kHalfAround));
}

/// Returns where the tip is after the turn, relative to the start, in the start's space.
BENDY_ALWAYS_INLINE Vector tip_after(const Bend& bend, const Turn& turn) {
    return bend.bone + bend.along + bend.across * turn.cosine + cross(bend.axis, bend.across) * turn.sine;
}

/// Rotates the start by the smallest rotation that brings the tip into the direction of the target.
BENDY_ALWAYS_INLINE Mask aim_start(const Vector& reached, const Reaching& reach, Rotation& upper) {
    const Vector from = turned(upper, reached);  // has the length of `way`
    const Vector by = cross(from, reach.way);
    const Number open = reach.distance + dot(from, reach.way);
    upper = Rotation{by.x, by.y, by.z, open} * upper;
    constexpr double kOpposite = 1e-9;
    const Mask is_whole = normalize(upper);
    return both(is_whole, open > kOpposite * reach.distance);
}

/// Rotates the start from the tip's direction and the knee's side to the target's direction and the pole's side.
BENDY_ALWAYS_INLINE Mask aim_with_pole(const Limb& limb, const Bend& bend, const Vector& reached, const Reaching& reach,
                                       Rotation& upper) {
    const Vector pole = chosen(limb.is_pole_point, from_model(limb.base, limb.pole) - limb.origin, limb.pole);
    Vector to_z;
    Mask is_clear = find_normal(reach.way, pole, to_z);
    Vector from_z = bend.axis * -1.0;
    if (is_any(limb.is_fixed)) {
        Vector normal;
        is_clear = both(is_clear, either(find_normal(reached, bend.bone, normal), opposite(limb.is_fixed)));
        from_z = chosen(limb.is_fixed, normal, from_z);
    }
    const Number unit = 1.0 / root(reach.distance);
    const Vector from_x = reached * unit, to_x = reach.way * unit;
    if (is_any(limb.is_rolled)) {
        to_z = chosen(limb.is_rolled, rolled(to_z, to_x, limb.roll_cosine, limb.roll_sine), to_z);
    }
    const Vector from_y = cross(from_z, from_x), to_y = cross(to_z, to_x);
    upper = rotation_of(to_x * from_x.x + to_y * from_y.x + to_z * from_z.x,
                        to_x * from_x.y + to_y * from_y.y + to_z * from_z.y,
                        to_x * from_x.z + to_y * from_y.z + to_z * from_z.z, upper);
    return is_clear;
}

/// Completes a reach after the middle joint's turn. Returns the distance from the tip to the target in metres; negative
/// if that is outside the tolerance.
BENDY_ALWAYS_INLINE Number finish(const Limb& limb, const Bend& bend, const Turn& turn, Reaching& reach) {
    const Vector reached = tip_after(bend, turn);
    const Rotation before = reach.upper;
    Mask is_aimed = limb.has_pole;
    if (is_any(limb.has_pole)) is_aimed = both(aim_with_pole(limb, bend, reached, reach, reach.upper), limb.has_pole);
    if (!is_every(limb.has_pole)) {
        Rotation upper = before;
        const Mask is_straight = both(aim_start(reached, reach, upper), opposite(limb.has_pole));
        is_aimed = either(is_aimed, is_straight);
        reach.upper = chosen(limb.has_pole, reach.upper, upper);
    }
    const Number length = root(squared(bend.bone)) + root(squared(reach.rest));
    const Number distance = root(reach.distance);
    const Number left = absolute(root(squared(reached)) - distance);  // the direction is already right
    const Number tolerance = tolerance_in(limb.base, limb.tolerance, length);
    const Vector missed = reach.way * (left / distance);
    const Vector in_model = limb.base[0] * missed.x + limb.base[1] * missed.y + limb.base[2] * missed.z;
    const Mask is_there = both(is_aimed, both(left <= tolerance, squared(reach.upper) > Number(0.5)));
    return chosen(is_there, root(squared(in_model)), -1.0);
}

// NOLINTEND(misc-definitions-in-headers)
