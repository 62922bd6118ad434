#!/usr/bin/env python3
"""Is a hex mesh proper, and its boundary the quads of the file? Shares nothing with hexfill: reads a legacy VTK file (ASCII) with hexes and quads.

    python3 tests/proper.py MESH.vtk
"""
import sys,itertools,collections
def read(p):
    t=open(p).read().split()
    i=t.index('POINTS'); n=int(t[i+1])
    i=t.index('CELLS'); nc=int(t[i+1]); k=i+3
    cells=[]
    for _ in range(nc):
        m=int(t[k]); cells.append([int(x) for x in t[k+1:k+1+m]]); k+=m+1
    return n,cells
F=[(0,4,7,3),(1,2,6,5),(0,1,5,4),(3,7,6,2),(0,3,2,1),(4,5,6,7)]
E=[(0,1),(1,2),(2,3),(3,0),(4,5),(5,6),(6,7),(7,4),(0,4),(1,5),(2,6),(3,7)]
n,cells=read(sys.argv[1])
H=[c for c in cells if len(c)==8]; Q=[c for c in cells if len(c)==4]
print(len(H),'hexes',len(Q),'quads')
assert all(len(set(h))==8 for h in H)
fac=collections.defaultdict(list)
for i,h in enumerate(H):
    for f in F: fac[frozenset(h[k] for k in f)].append((i,[h[k] for k in f]))
assert all(len(v)<=2 for v in fac.values())
def cyc(q):
    i=q.index(min(q)); a=q[i:]+q[:i]; b=[a[0]]+a[:0:-1]; return min(tuple(a),tuple(b))
for v in fac.values():
    assert len({cyc(q) for _,q in v})==1   # same cyclic order
bd={cyc(v[0][1]) for v in fac.values() if len(v)==1}
assert bd=={cyc(q) for q in Q} and len(bd)==len(Q), 'boundary'
# proper intersection
faces=[]
for h in H:
    s={frozenset([v]) for v in h}|{frozenset((h[a],h[b])) for a,b in E}|{frozenset(h[k] for k in f) for f in F}
    faces.append(s)
bad=0
for i,j in itertools.combinations(range(len(H)),2):
    c=frozenset(H[i])&frozenset(H[j])
    if c and not (c in faces[i] and c in faces[j]): bad+=1
print('improper pairs',bad)
# vertex links: triangles of corners; must be sphere (interior) or disk (boundary)
bv={v for q in bd for v in q}
NB={0:(1,3,4),1:(0,2,5),2:(1,3,6),3:(0,2,7),4:(0,5,7),5:(1,4,6),6:(2,5,7),7:(3,4,6)}
used=sorted({v for h in H for v in h})
for v in used:
    tris=[]
    for h in H:
        if v in h:
            k=h.index(v); tris.append(tuple(h[x] for x in NB[k]))
    e=collections.Counter(frozenset(p) for t in tris for p in itertools.combinations(t,2))
    vs={x for t in tris for x in t}
    chi=len(vs)-len(e)+len(tris)
    # connected
    seen={tris[0]};st=[tris[0]]
    while st:
        a=st.pop()
        for b in tris:
            if b not in seen and len(set(a)&set(b))==2: seen.add(b);st.append(b)
    assert len(seen)==len(tris)
    # link of each link-vertex is a path or cycle
    for x in vs:
        nb=[tuple(y for y in t if y!=x) for t in tris if x in t]
        deg=collections.Counter(y for p in nb for y in p)
        ones=[y for y in deg if deg[y]==1]
        assert max(deg.values())<=2 and len(ones) in (0,2) and len(deg)==len(nb)+(1 if ones else 0)
    border=[y for y in e if e[y]==1]
    assert max(e.values())<=2
    assert (chi==1 and border) if v in bv else (chi==2 and not border),(v,chi)
print('all vertex links are spheres or disks; vertices',len(used))
vs=len(used); es=len({frozenset((h[a],h[b])) for h in H for a,b in E}); fs=len(fac)
print('euler',vs-es+fs-len(H))
