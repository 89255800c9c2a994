// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pqVoxplexMeshing.h"

#include "vtkImageToSimplexMeshFilter.h"
#include "vtkSMLabelColorsProxy.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqDataRepresentation.h"
#include "pqPipelineSource.h"
#include "pqProgressManager.h"
#include "pqRenderView.h"
#include "pqServer.h"
#include "pqServerManagerModel.h"

#include "vtkAlgorithm.h"
#include "vtkNew.h"
#include "vtkSMPVRepresentationProxy.h"
#include "vtkSMSourceProxy.h"

#include <QApplication>
#include <QInputEvent>
#include <QTimer>
#include <QWidget>

#include <algorithm>

namespace
{

/** A legend of more names covers half of the view. */
constexpr std::size_t MostNamesInLegend = 30;

/** A property of sources whose first mesh has been brought into view. */
constexpr char WasShown[] = "VoxplexWasShown";

/** One of the plugin's filters that take long, if it is in this process, or null. */
vtkImageToSimplexMeshFilter* MesherOf(pqPipelineSource* source)
{
  return vtkImageToSimplexMeshFilter::SafeDownCast(source->getProxy()->GetClientSideObject());
}

/** Whether a proxy is a filter of the plugin, so that the array Label has labels whether or not they have names. */
bool IsMeshOfOurs(vtkSMProxy* proxy)
{
  const QString name = proxy->GetXMLName();
  return name == "VoxplexTetMesh" || name == "VoxplexPentatopeMesh";
}

/** Brings the first mesh of a source into view. Beside other data the camera stays where the user has put it. */
void ShowFirst(pqPipelineSource* source, bool hideLegend)
{
  auto* const view = qobject_cast<pqRenderView*>(pqActiveObjects::instance().activeView());
  pqDataRepresentation* const shown = view ? source->getRepresentation(0, view) : nullptr;
  auto* const proxy = shown ? vtkSMPVRepresentationProxy::SafeDownCast(shown->getProxy()) : nullptr;
  if (proxy == nullptr)
  {
    return;
  }
  if (hideLegend)
  {
    proxy->SetScalarBarVisibility(view->getProxy(), false);
  }
  const QList<pqRepresentation*> all = view->getRepresentations();
  const bool isAlone = std::none_of(all.begin(), all.end(),
    [shown](pqRepresentation* other)
    { return other != shown && qobject_cast<pqDataRepresentation*>(other) && other->isVisible(); });
  if (isAlone)
  {
    view->resetCamera();
  }
}

} // namespace

pqVoxplexMeshing::pqVoxplexMeshing(QObject* parent)
  : QObject(parent)
{
}

void pqVoxplexMeshing::startup()
{
  pqApplicationCore* const core = pqApplicationCore::instance();
  pqProgressManager* const progress = core->getProgressManager();
  this->connect(
    progress, SIGNAL(progress(const QString&, int)), SLOT(onProgress(const QString&, int)));
  this->connect(progress, SIGNAL(progressEndEvent()), SLOT(onProgressEnd()));
  // From 6.1 on the signal is gone: ParaView handles events itself while any filter executes, and stops it.
  this->HandlesButton = progress->metaObject()->indexOfSignal("abort()") >= 0;
  if (this->HandlesButton)
  {
    this->connect(progress, SIGNAL(abort()), SLOT(onAbort()));
  }
  this->connect(core->getServerManagerModel(), SIGNAL(dataUpdated(pqPipelineSource*)),
    SLOT(onDataUpdated(pqPipelineSource*)));
}

void pqVoxplexMeshing::shutdown()
{
  if (pqApplicationCore* const core = pqApplicationCore::instance())
  {
    core->getProgressManager()->disconnect(this);
    core->getServerManagerModel()->disconnect(this);
  }
}

void pqVoxplexMeshing::onProgress(const QString& message, int percent)
{
  // The message is the class of the filter that executes, without "vtk".
  pqServer* const server = pqActiveObjects::instance().activeServer();
  if (!message.startsWith("ImageTo") || !message.endsWith("MeshFilter") || server == nullptr ||
    server->isRemote() || this->HandlesEvents)
  {
    return;
  }
  pqProgressManager* const progress = pqApplicationCore::instance()->getProgressManager();
  if (!this->Executes)
  {
    this->Executes = true;
    // The progress manager keeps the mouse from the button's window, and so from the button. This filter does not.
    this->WereUnblocked = progress->unblockEvents(true);
    QCoreApplication::instance()->installEventFilter(this);
    if (this->HandlesButton)
    {
      progress->setEnableAbort(true);
    }
  }
  // With a dialog open nobody can press the button. Nothing is handled at 0: as in ParaView.
  if (this->HandlesButton && percent > 0 && QApplication::activeModalWidget() == nullptr)
  {
    this->HandlesEvents = true;
    QCoreApplication::processEvents(QEventLoop::ExcludeSocketNotifiers);
    this->HandlesEvents = false;
  }
}

bool pqVoxplexMeshing::eventFilter(QObject* object, QEvent* event)
{
  // Calls that are queued cannot wait. If one has opened a dialog, the user must be able to close it.
  if (QApplication::activeModalWidget() != nullptr ||
    pqApplicationCore::instance()->getProgressManager()->nonBlockableObjects().contains(object))
  {
    return false;
  }
  const QEvent::Type type = event->type();
  const bool renders = type == QEvent::Paint && object->inherits("QOpenGLWidget"); // which updates
  if (type == QEvent::Timer || renders)
  {
    const Waiting waiting(object, renders ? 0 : static_cast<QTimerEvent*>(event)->timerId());
    if (!this->Postponed.contains(waiting))
    {
      this->Postponed.append(waiting);
    }
    return true;
  }
  if (type == QEvent::Close || type == QEvent::Drop)
  {
    event->ignore();
    return true;
  }
  // Windows hand input to their widgets, of which only the button gets it.
  return type == QEvent::Shortcut ||
    (dynamic_cast<QInputEvent*>(event) != nullptr && !object->isWindowType());
}

void pqVoxplexMeshing::onProgressEnd()
{
  if (!this->Executes)
  {
    return;
  }
  this->Executes = false;
  QCoreApplication::instance()->removeEventFilter(this);
  pqProgressManager* const progress = pqApplicationCore::instance()->getProgressManager();
  progress->unblockEvents(this->WereUnblocked);
  if (this->HandlesButton)
  {
    progress->setEnableAbort(false);
  }
  for (const Waiting& waiting : this->Postponed)
  {
    if (waiting.second != 0 && waiting.first)
    {
      QCoreApplication::postEvent(waiting.first, new QTimerEvent(waiting.second));
    }
    else if (auto* const widget = qobject_cast<QWidget*>(waiting.first))
    {
      widget->update();
    }
  }
  this->Postponed.clear();
}

void pqVoxplexMeshing::onAbort()
{
  if (!this->Executes)
  {
    return;
  }
  const auto sources =
    pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>();
  for (pqPipelineSource* source : sources)
  {
    if (vtkAlgorithm* const mesher = MesherOf(source))
    {
      mesher->SetAbortExecute(1); // one that does not execute forgets it when it starts
    }
  }
}

void pqVoxplexMeshing::onDataUpdated(pqPipelineSource* source)
{
  vtkSMSourceProxy* const proxy = source->getSourceProxy();
  if (proxy == nullptr || !(IsMeshOfOurs(proxy) || vtkSMLabelColorsProxy::HasLabels(proxy, 0)))
  {
    return;
  }
  if (vtkImageToSimplexMeshFilter* const mesher = MesherOf(source); mesher && mesher->GetAborted())
  {
    qWarning(
      "Meshing was aborted, so there is no mesh. Change a property and press Apply to mesh again.");
  }
  vtkNew<vtkPVLabelInformation> labels;
  vtkSMLabelColorsProxy::Gather(proxy, 0, labels);
  const auto isApplied = [this](const auto& label)
  {
    const auto found = this->Applied.find(label.first);
    return found != this->Applied.end() && found->second == label.second;
  };
  // A mesh may have some of the image's labels only.
  if (!std::all_of(labels->GetLabels().begin(), labels->GetLabels().end(), isApplied))
  {
    this->Applied = labels->GetLabels();
    vtkSMLabelColorsProxy::Apply(labels, proxy->GetSessionProxyManager());
  }
  if (IsMeshOfOurs(proxy) && !labels->GetLabels().empty() && !source->property(WasShown).toBool())
  {
    source->setProperty(WasShown, true);
    // Apply makes the representation, and its legend, after this.
    QTimer::singleShot(0, source,
      [source, hideLegend = labels->GetLabels().size() > MostNamesInLegend]
      { ShowFirst(source, hideLegend); });
  }
}
